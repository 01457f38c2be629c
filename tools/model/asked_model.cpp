// SPDX-License-Identifier: MIT
// Every kind of model that `train` exports, for `evaluate` and `certify`: features, answer and schema of each.
#include "model/asked_model.hpp"

#include <stdexcept>

#include "model/agreement.hpp"
#include "model/log_schemas.hpp"
#include "model/run_time_model.hpp"
#include "pinnquad/data/flight_features.hpp"

namespace programs {

namespace {

using namespace pinnquad;

template <class Features, class Outputs, class Scalar>
class AskedModelOf : public AskedModel {
  using Model = RunTimeModel<Features, Outputs, Scalar>;
  using Derivatives = NetworkDerivatives<Features, Outputs>;

 public:
  AskedModelOf(const Block& block, const Identity& identity)
      : model_(block, identity),
        derivatives_(summands<double>(identity.networks, block.parameters),
                     scaler_of<typename Derivatives::InputScaler>(block.input_mean, block.input_deviation),
                     scaler_of<typename Derivatives::OutputScaler>(block.output_mean, block.output_deviation),
                     RunTimeAirframe(identity.airframe.name, identity.airframe.value)),
        lower_(block.envelope_lower),
        upper_(block.envelope_upper) {
    names.assign(Features::names.begin(), Features::names.end());
    for (int tap = 0; tap < Derivatives::all_taps; ++tap) {
      const int place = angular_acceleration_at<Features>(tap);
      if (place >= 0) taps.push_back(place);
    }
    columns = wanted_columns<Features>();
    signed_sums = is_signed_sums<Outputs>;
    if constexpr (is_windowed<Features>) seen = {Features::Window::period_s, Features::Window::earliest_s};
    using Base = typename pinnquad::detail::BaseOf<Outputs>::type;
    bool curved = false;  // a formula's commands are no affine map of what it reads then
    for (const auto& rotor : identity.airframe.value.rotors) curved = curved || rotor.thrust_curve > 0;
    affine_schema = !std::is_same_v<Outputs, RotorSpeedOutputs> &&
                    !(curved && pinnquad::detail::reads_angular_acceleration<Base>());
  }

  Commands<double> commands(const std::vector<double>& x) const override {
    typename Model::FeatureVector features{};
    for (std::size_t i = 0; i < features.size(); ++i) features[i] = static_cast<Scalar>(x[i]);
    return in_double(model_.predict(features));
  }
  AxisDerivatives derivatives(const std::vector<double>& x, bool held) const override {
    typename Derivatives::FeatureVector features{};
    for (std::size_t i = 0; i < features.size(); ++i) features[i] = x[i];
    return derivatives_(features, held ? Derivatives::all_taps - 1 : 0);
  }
  void answer(const RowSet& rows, const std::function<void(std::size_t, const AnsweredRow&)>& take) const override {
    std::size_t first = 0;
    for (const FlightRows& piece : rows.pieces()) {
      const FlightInputs<typename Features::template Inputs<Scalar>> own(piece);
      const FlightInputs<typename Features::template Inputs<double>> exact(piece);
      for (std::size_t row = piece.rows.begin; row < piece.rows.end; ++row) {
        typename Features::template Inputs<Scalar> inputs;
        typename Features::template Inputs<double> exact_inputs;
        if (!own.read(row, inputs) || !exact.read(row, exact_inputs)) continue;
        typename Model::FeatureVector x{};
        Features::extract(inputs, x.data());
        typename Derivatives::FeatureVector exact_x{};
        Features::extract(exact_inputs, exact_x.data());
        AnsweredRow answered;
        answered.commands = in_double(model_.predict(x));
        answered.derivatives = derivatives_(exact_x);
        for (std::size_t i = 0; i < x.size(); ++i) {
          const auto value = static_cast<double>(x[i]);
          answered.inside_envelope = answered.inside_envelope && value >= lower_[i] && value <= upper_[i];
        }
        take(first + row - piece.rows.begin, answered);
      }
      first += piece.rows.size();
    }
  }

 private:
  static Commands<double> in_double(const Commands<Scalar>& own) {
    Commands<double> commands{};
    for (std::size_t i = 0; i < commands.size(); ++i) commands[i] = static_cast<double>(own[i]);
    return commands;
  }

  Model model_;
  Derivatives derivatives_;
  std::vector<double> lower_, upper_;
};

}  // namespace

std::unique_ptr<const AskedModel> asked_model(const Block& block, const Identity& identity, bool is_to_fly) {
  std::unique_ptr<const AskedModel> model;
  const auto is_it = [&](auto features, auto outputs) {
    using Features = decltype(features);
    using Outputs = decltype(outputs);
    return !model && detail::base_of<Outputs>() == block.base &&
           detail::shape_hash_of<Features, Outputs>(identity.answer, identity.airframe) == block.shape_hash;
  };
  each_schema([&](auto features, auto outputs) {
    using Features = decltype(features);
    using Outputs = decltype(outputs);
    if (!is_it(features, outputs)) return;
    require_agreement<Features>(block, identity);
    if (block.is_double) {
      model = std::make_unique<AskedModelOf<Features, Outputs, double>>(block, identity);
    } else {
      model = std::make_unique<AskedModelOf<Features, Outputs, float>>(block, identity);
    }
  });
  each_log_schema([&](auto features, auto outputs) {  // trained in float
    using Features = decltype(features);
    using Outputs = decltype(outputs);
    if (block.is_double || !is_it(features, outputs)) return;
    require_agreement<Features>(block, identity);
    model = std::make_unique<AskedModelOf<Features, Outputs, float>>(block, identity);
  });
  if (!model) throw InputError(block.path, 0, 0, "a model of float", "one of double with these features");
  require_self_test(block, identity, *model, is_to_fly);
  return model;
}

}  // namespace programs
