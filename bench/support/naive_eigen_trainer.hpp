// SPDX-License-Identifier: MIT
// The yardstick of training: back-propagation as a user types it into Eigen, with sizes known at compile time, a sample
// per column, `noalias` on every product and Adam on whole arrays. Shuffles and gathers like the trainer it is compared
// with.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "pinnquad/core/random.hpp"
#include "pinnquad/training/adam.hpp"
#include "pinnquad/training/flush_denormals.hpp"
#include "support/training_set.hpp"

namespace pinnquad::bench {

class NaiveEigenTrainer {
 public:
  NaiveEigenTrainer(const PaperNetwork& network, const Adam& adam) : adam_(adam) {
    first_.load(network, 0);
    for (std::size_t i = 0; i < hidden_.size(); ++i) hidden_[i].load(network, 2 * static_cast<int>(i) + 2);
    last_.load(network, 20);
  }

  /// One pass over the data in an order drawn from the engine; the mean loss (mean squared error) over the samples.
  template <class Engine>
  double epoch(const PaperTrainingData& data, Engine& engine) {
    if (static_cast<int>(order_.size()) != data.size()) {
      order_.resize(static_cast<std::size_t>(data.size()));
      std::iota(order_.begin(), order_.end(), 0);
    }
    shuffle(order_, engine);
    double sum = 0;
    for (int first = 0; first < data.size(); first += batch_size) {
      const int size = std::min(batch_size, data.size() - first);
      sum += size * static_cast<double>(batch(data, order_.data() + first, size));
    }
    return sum / data.size();
  }

  float batch(const PaperTrainingData& data, const int* rows, int size) {
    const FlushDenormals flush;  // as ours: the yardstick is not to lose by dead neurons
    for (int i = 0; i < size; ++i) {
      x_.col(i) = Eigen::Map<const Eigen::Matrix<float, 16, 1>>(data.features_of(rows[i]));
      target_.col(i) = Eigen::Map<const Eigen::Matrix<float, 4, 1>>(data.outputs_of(rows[i]));
    }
    first_.forward(x_, h_[0]);
    h_[0] = h_[0].cwiseMax(0.0f);
    for (std::size_t i = 0; i < hidden_.size(); ++i) {
      hidden_[i].forward(h_[i], h_[i + 1]);
      h_[i + 1] = h_[i + 1].cwiseMax(0.0f);
    }
    last_.forward(h_.back(), y_);

    dy_ = y_ - target_;
    dy_.rightCols(batch_size - size).setZero();  // a smaller last batch
    const float count = static_cast<float>(4 * size);
    const float loss = dy_.squaredNorm() / count;
    dy_ *= 2.0f / count;

    last_.differentiate(h_.back(), dy_);
    last_.backward(dy_, dh_);
    for (std::size_t i = hidden_.size(); i-- > 0;) {
      dh_ = (h_[i + 1].array() > 0.0f).select(dh_, 0.0f);
      hidden_[i].differentiate(h_[i], dh_);
      hidden_[i].backward(dh_, other_);
      dh_.swap(other_);
    }
    dh_ = (h_[0].array() > 0.0f).select(dh_, 0.0f);
    first_.differentiate(x_, dh_);

    const Adam::Step step = adam_.begin(++steps_);
    first_.update(adam_, step);
    for (auto& layer : hidden_) layer.update(adam_, step);
    last_.update(adam_, step);
    return loss;
  }

  /// Weights in the library's layout, to be compared.
  PaperNetwork network() const {
    PaperNetwork result;
    first_.store(result, 0);
    for (std::size_t i = 0; i < hidden_.size(); ++i) hidden_[i].store(result, 2 * static_cast<int>(i) + 2);
    last_.store(result, 20);
    return result;
  }

 private:
  static constexpr int batch_size = 64;
  template <int Rows>
  using Batch = Eigen::Matrix<float, Rows, batch_size>;

  /// A parameter array with its gradient and moments.
  template <class Array>
  struct Trained {
    Array value = Array::Zero();
    Array gradient = Array::Zero();
    Array first = Array::Zero();
    Array second = Array::Zero();

    void update(const Adam& adam, const Adam::Step& step) {
      const float b1 = static_cast<float>(adam.beta_1), b2 = static_cast<float>(adam.beta_2);
      gradient += static_cast<float>(adam.weight_decay) * value;
      first = b1 * first + (1.0f - b1) * gradient;
      second = b2 * second + (1.0f - b2) * gradient.cwiseProduct(gradient);
      value.array() -= static_cast<float>(step.rate) * first.array() /
                       (second.array().sqrt() * static_cast<float>(step.root_scale) + static_cast<float>(adam.epsilon));
    }
  };

  template <int In, int Out>
  struct Layer {
    Trained<Eigen::Matrix<float, Out, In>> weight;
    Trained<Eigen::Matrix<float, Out, 1>> bias;

    void load(const PaperNetwork& network, int index) {
      const float* parameters = network.parameters.data() + PaperNetwork::Sizes::offset(index);
      weight.value = Eigen::Map<const Eigen::Matrix<float, Out, In, Eigen::RowMajor>>(parameters);
      bias.value = Eigen::Map<const Eigen::Matrix<float, Out, 1>>(parameters + Out * In);
    }
    void store(PaperNetwork& network, int index) const {
      float* parameters = network.parameters.data() + PaperNetwork::Sizes::offset(index);
      Eigen::Map<Eigen::Matrix<float, Out, In, Eigen::RowMajor>>(parameters, Out, In) = weight.value;
      Eigen::Map<Eigen::Matrix<float, Out, 1>>(parameters + Out * In) = bias.value;
    }
    void forward(const Batch<In>& x, Batch<Out>& y) const {
      y.noalias() = weight.value * x;
      y.colwise() += bias.value;
    }
    void differentiate(const Batch<In>& x, const Batch<Out>& dy) {
      weight.gradient.noalias() = dy * x.transpose();
      bias.gradient = dy.rowwise().sum();
    }
    void backward(const Batch<Out>& dy, Batch<In>& dx) const { dx.noalias() = weight.value.transpose() * dy; }
    void update(const Adam& adam, const Adam::Step& step) {
      weight.update(adam, step);
      bias.update(adam, step);
    }
  };

  Adam adam_;
  Layer<16, 25> first_;
  std::array<Layer<25, 25>, 9> hidden_;
  Layer<25, 4> last_;
  Batch<16> x_;
  std::array<Batch<25>, 10> h_;
  Batch<25> dh_, other_;
  Batch<4> target_ = Batch<4>::Zero(), y_, dy_;
  std::vector<int> order_;
  long steps_ = 0;

 public:
  EIGEN_MAKE_ALIGNED_OPERATOR_NEW
};

}  // namespace pinnquad::bench
