// SPDX-License-Identifier: MIT
#include "training/trained_network.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "airframe/choice.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/decimal.hpp"

namespace programs {

namespace {

/// As a model of this scalar is asked.
template <class Scalar>
std::vector<double> motion_numbers(const pinnquad::Sample& sample, bool with_altitude) {
  const auto in = pinnquad::sample_inputs<pinnquad::MotionInputsWithAltitude<Scalar>>(sample);
  std::vector<double> numbers;
  for (const auto* vector :
       {&in.linear_acceleration_m_s2, &in.angular_acceleration_rad_s2, &in.velocity_m_s, &in.body_rates_rad_s}) {
    for (int i = 0; i < 3; ++i) numbers.push_back(static_cast<double>((*vector)[i]));
  }
  const pinnquad::Quaternion<Scalar>& q = in.attitude;
  for (const Scalar part : {q.w, q.x, q.y, q.z}) numbers.push_back(static_cast<double>(part));
  if (with_altitude) numbers.push_back(static_cast<double>(in.altitude_m));
  return numbers;
}

bool beyond_limits(const pinnquad::Commands<double>& commands) {
  return std::any_of(commands.begin(), commands.end(), [](double u) { return u < 0 || u > 1; });
}

bool is_finite(const pinnquad::Commands<double>& commands) {
  return std::all_of(commands.begin(), commands.end(), [](double u) { return std::isfinite(u); });
}

}  // namespace

GuardCounts& GuardCounts::operator+=(const GuardCounts& other) {
  rows += other.rows;
  warming_up += other.warming_up;
  outside_envelope += other.outside_envelope;
  output_not_finite += other.output_not_finite;
  beyond_limits += other.beyond_limits;
  for (const auto& [feature, count] : other.furthest) furthest[feature] += count;
  return *this;
}

Answers TrainedNetwork::answers(const pinnquad::RowSet& rows) const {
  Answers result{predictions(rows), derivatives(rows), {}};
  for (const pinnquad::Commands<double>& commands : result.predictions) {
    ++result.guard.rows;
    if (!is_finite(commands)) ++result.guard.warming_up;
    if (is_finite(commands) && beyond_limits(commands)) ++result.guard.beyond_limits;
  }
  return result;
}

std::optional<pinnquad::Certificate> TrainedNetwork::certificate() const {
  return block() != nullptr ? block()->certificate() : std::nullopt;
}

bool TrainedNetwork::is_proven() const { return block() != nullptr && block()->proven_signs().has_value(); }

BlockNetwork::BlockNetwork(const std::vector<unsigned char>& block) : block_("a trained model", block) {}

BlockNetwork::BlockNetwork(const pinnquad::GroundModel<float>& model, const pinnquad::RowSet& training)
    : BlockNetwork(pinnquad::model_block(model, pinnquad::golden_features(model, training), {})) {}

ExportableNetwork::ExportableNetwork(pinnquad::GroundModel<float> model, const pinnquad::RowSet& training,
                                     bool with_trust)
    : BlockNetwork(model, training), model_(std::move(model)), with_trust_(with_trust) {}

pinnquad::Exported ExportableNetwork::export_to(const pinnquad::Exported::Files& files, const std::string& name,
                                                const pinnquad::RowSplit& split,
                                                const pinnquad::Provenance& provenance) const {
  return pinnquad::export_model(files, name, model_, split, provenance);
}

pinnquad::GroundModel<float> of_library_airframe(pinnquad::GroundModel<float> model) {
  with_airframe(std::string(model.written.vehicle_name), [&model](auto tag) {
    using Vehicle = typename decltype(tag)::type;
    pinnquad::detail::take_airframe<pinnquad::CommandOutputs>(model.written, Vehicle::name,
                                                              pinnquad::airframe_value<Vehicle, double>(),
                                                              pinnquad::airframe_value<Vehicle, float>());
    model.written.vehicle_type = pinnquad::type_name<Vehicle>();
  });
  return model;
}

Predictions BlockNetwork::predictions(const pinnquad::RowSet& rows) const { return commands(rows, false); }

Predictions BlockNetwork::guarded_predictions(const pinnquad::RowSet& rows) const { return commands(rows, true); }

Answers BlockNetwork::answers(const pinnquad::RowSet& rows) const {
  const std::vector<double> lower = block_.envelope_lower(), upper = block_.envelope_upper();
  const std::vector<std::string> names = block_.feature_names();
  Answers result;
  result.predictions = without_answer(rows);
  GuardCounts& counts = result.guard;
  counts.rows = rows.size();
  counts.warming_up = rows.size();
  DerivativeSigns signs;
  const auto take = [&](std::size_t row, const pinnquad::BlockModel::AnsweredRow& answer) {
    result.predictions[row] = answer.commands;
    signs.add(answer.derivatives);
    --counts.warming_up;
    if (!answer.inside_envelope) {
      ++counts.outside_envelope;
      std::size_t furthest = 0;
      double most = -1;
      for (std::size_t i = 0; i < names.size(); ++i) {
        const double x = answer.features[i], beyond = std::max(lower[i] - x, x - upper[i]);
        if (block_.features().is_column(static_cast<int>(i)) && std::isfinite(x)) continue;  // it saturates
        const double half_widths = 2 * beyond / (upper[i] - lower[i]);
        if (half_widths <= most) continue;
        most = half_widths;
        furthest = i;
      }
      ++counts.furthest[names[furthest].substr(0, names[furthest].find('['))];
    } else if (!is_finite(answer.commands)) {
      ++counts.output_not_finite;
    } else if (beyond_limits(answer.commands)) {
      ++counts.beyond_limits;
    }
  };
  block_.answer(rows, take);
  result.derivatives = signs.figures();
  return result;
}

/// NaN for a row without features and, if `guarded`, for one outside the training envelope.
Predictions BlockNetwork::commands(const pinnquad::RowSet& rows, bool guarded) const {
  Predictions result = without_answer(rows);
  const auto take = [&](std::size_t row, const pinnquad::BlockModel::AnsweredRow& answer) {
    if (answer.inside_envelope || !guarded) result[row] = answer.commands;
  };
  block_.answer(rows, take, false);
  return result;
}

void write_replay(const std::string& path, const pinnquad::BlockModel& model, const pinnquad::RowSet& rows) {
  const pinnquad::RunTimeFeatures& features = model.features();
  const bool asks_for_motion = features.window().taps == 1 && features.column_count() == 0;
  const bool with_altitude = features.asks_for_altitude();
  std::size_t count = 0, asked = 0;
  std::string lines;
  const auto take = [&](std::size_t row, const pinnquad::BlockModel::AnsweredRow& answer) {
    const pinnquad::Sample& sample = rows[row];
    std::vector<double> numbers = !asks_for_motion    ? answer.features
                                  : model.is_double() ? motion_numbers<double>(sample, with_altitude)
                                                      : motion_numbers<float>(sample, with_altitude);
    asked = numbers.size();
    numbers.insert(numbers.end(), answer.commands.begin(), answer.commands.end());
    numbers.insert(numbers.end(), sample.commands.begin(), sample.commands.end());
    for (std::size_t i = 0; i < numbers.size(); ++i) lines += (i > 0 ? " " : "") + pinnquad::number_text(numbers[i]);
    lines += '\n';
    ++count;
  };
  model.answer(rows, take, false);
  pinnquad::AtomicFile file(path);
  file.stream() << (asks_for_motion ? "pinnquad-replay 1 " : "pinnquad-replay-features 1 ") << count << ' '
                << asked + 2 * pinnquad::rotor_count << '\n'
                << lines;
  file.commit();
}

}  // namespace programs
