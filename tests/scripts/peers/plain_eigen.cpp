// SPDX-License-Identifier: MIT
// A peer as a user writes one: Eq. (4) and its training in plain Eigen, matrices of sizes known at run time alone.
// The environment's WRONG, network or trainer, is a fault that the check before the first timing must find. peers.cmake
// gives SECOND_MOMENT.
#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "peer.hpp"

namespace {

bool wrong(std::string_view what) {
  static const char* const planted = std::getenv("WRONG");
  return planted != nullptr && what == planted;
}

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Layer {
  Matrix weight;
  Eigen::VectorXf bias;
};

std::vector<Layer> layers_of(const float* parameters) {
  std::vector<Layer> layers;
  for (int in = 16, index = 0; index < 11; ++index) {
    const int out = index < 10 ? 25 : 4;
    layers.push_back(
        {Eigen::Map<const Matrix>(parameters, out, in), Eigen::Map<const Eigen::VectorXf>(parameters + out * in, out)});
    parameters += out * (in + 1);
    in = out;
  }
  return layers;
}

class PlainNetwork {
 public:
  explicit PlainNetwork(const float* parameters) : layers_(layers_of(parameters)) {}

  void forward(const float* x, float* y) const {
    Eigen::VectorXf h = Eigen::Map<const Eigen::VectorXf>(x, 16);
    for (const Layer& layer : layers_) {
      h = layer.weight * h + layer.bias;
      if (&layer != &layers_.back()) h = h.cwiseMax(0.0F);
    }
    if (wrong("network")) h[3] += 1e-3F;
    Eigen::Map<Eigen::VectorXf>(y, 4) = h;
  }

 private:
  std::vector<Layer> layers_;
};

class PlainTrainer {
 public:
  explicit PlainTrainer(const pinnquad::bench::TrainingTask& task) : task_(task), layers_(layers_of(task.parameters)) {
    for (const Layer& layer : layers_) {
      const Layer zero{0.0F * layer.weight, 0.0F * layer.bias};
      first_.push_back(zero);
      second_.push_back(zero);
    }
  }

  double epoch(const int* order) {
    double sum = 0;
    for (int first = 0; first < task_.samples; first += 64) {
      const int size = std::min(64, task_.samples - first);
      sum += size * batch(order + first, size);
    }
    return sum / task_.samples;
  }

 private:
  double batch(const int* rows, int size) {
    std::vector<Matrix> h{Matrix(16, size)};
    Matrix dy(4, size);
    for (int i = 0; i < size; ++i) {
      h[0].col(i) = Eigen::Map<const Eigen::VectorXf>(task_.features + 16 * rows[i], 16);
      dy.col(i) = Eigen::Map<const Eigen::VectorXf>(task_.outputs + 4 * rows[i], 4);
    }
    for (const Layer& layer : layers_) {
      Matrix y = (layer.weight * h.back()).colwise() + layer.bias;
      if (&layer != &layers_.back()) y = y.cwiseMax(0.0F);
      h.push_back(y);
    }
    dy = h.back() - dy;
    const double loss = static_cast<double>(dy.squaredNorm()) / (4.0 * size);
    dy *= 2.0F / (4.0F * static_cast<float>(size));
    ++step_;
    for (std::size_t k = layers_.size(); k-- > 0;) {
      const Matrix dx = layers_[k].weight.transpose() * dy;
      const Matrix dw = dy * h[k].transpose();
      const Eigen::VectorXf db = dy.rowwise().sum();
      update(layers_[k].weight, dw, first_[k].weight, second_[k].weight);
      update(layers_[k].bias, db, first_[k].bias, second_[k].bias);
      if (k > 0) dy = (h[k].array() > 0.0F).select(dx, 0.0F);
    }
    return loss;
  }

  template <class Array>
  void update(Array& value, const Array& by_loss, Array& first, Array& second) const {
    const float t = static_cast<float>(step_), rate = 1e-3F / (1.0F - std::pow(0.9F, t));
    const float scale = 1.0F / std::sqrt(1.0F - std::pow(0.999F, t));
    const Array gradient = by_loss + 1e-5F * value;
    first = 0.9F * first + 0.1F * gradient;
    const float kept = wrong("trainer") ? 0.99F : SECOND_MOMENT;
    second = kept * second + (1.0F - kept) * gradient.cwiseProduct(gradient);
    value.array() -= rate * first.array() / (second.array().sqrt() * scale + 1e-8F);
  }

  pinnquad::bench::TrainingTask task_;
  std::vector<Layer> layers_, first_, second_;
  long step_ = 0;
};

const bool network = pinnquad::bench::add_peer_network<PlainNetwork>("plain_eigen");
const bool trainer = pinnquad::bench::add_peer_trainer<PlainTrainer>("plain_eigen");

}  // namespace
