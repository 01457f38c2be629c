// SPDX-License-Identifier: MIT
// The list of who competes in the command `beyond`. The paper's networks train as the study of Table 2 does.
#include "study/beyond_models.hpp"

#include <algorithm>
#include <optional>
#include <random>
#include <utility>

#include "command_line/listed.hpp"
#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "study/mirrored_rows.hpp"
#include "training/log_kinds.hpp"
#include "training/model_predictions.hpp"
#include "training/recipe.hpp"

namespace study {

namespace {

template <class Predict>
BeyondTraining evaluated(const BeyondTask& task, Predict predict) {
  return {programs::formula_model(task.airframe, std::move(predict)), false, false};
}

using Sample = pinnquad::Sample;
constexpr pinnquad::Commands<double> no_commands = {pinnquad::not_a_number, pinnquad::not_a_number,
                                                    pinnquad::not_a_number, pinnquad::not_a_number};

/// Commands of the hover at the begin of the paper's flight d1.
BeyondTraining evaluate_none(const BeyondTask& task) {
  const auto vehicle = pinnquad::flight_vehicle<pinnquad::AgileFlight>(task.airframe.airframe<double>());
  pinnquad::Commands<double> trim{};
  const pinnquad::Status status = hover_trim(vehicle, pinnquad::AgileFlight::plan().start_m, trim);
  return evaluated(
      task, [commands = status == pinnquad::Status::ok ? trim : no_commands](const Sample&) { return commands; });
}

BeyondTraining evaluate_formula(const BeyondTask& task) {
  const auto airframe = task.airframe.airframe<double>();
  return evaluated(task, [airframe, rotors = pinnquad::Rotors<double>(airframe)](const Sample& sample) {
    return programs::linear_prediction(airframe, rotors, sample);
  });
}

/// The equations of the vehicle of d1, its drag among them.
BeyondTraining evaluate_inverse(const BeyondTask& task) {
  const auto vehicle = pinnquad::flight_vehicle<pinnquad::AgileFlight>(task.airframe.airframe<double>());
  return evaluated(task, [vehicle](const Sample& sample) {
    pinnquad::State<double> state;
    state.position_m[2] = vehicle.site().ground_z_m - sample.altitude_m;
    state.attitude =
        pinnquad::from_euler(pinnquad::EulerAngles<double>{sample.roll_rad, sample.pitch_rad, sample.yaw_rad});
    state.velocity_m_s = pinnquad::body_to_world(state.attitude, sample.velocity_m_s);
    state.body_rates_rad_s = sample.body_rates_rad_s;
    pinnquad::Commands<double> commands = no_commands;
    static_cast<void>(pinnquad::inverse_commands(
        vehicle, state, {sample.linear_acceleration_m_s2, sample.angular_acceleration_rad_s2}, 0.0, commands));
    return commands;
  });
}

/// True of a model that is a base and a network on it, where the network is not bounded to nothing.
bool has_residual(const std::optional<pinnquad::Certificate>& certificate) {
  if (!certificate) return false;
  bool says = false;
  for (int k = 0; k < 4; ++k) says = says || certificate->residual_lower[k] < certificate->residual_upper[k];
  return says;
}

using Train = std::function<BeyondTraining(const BeyondTask&)>;

Train of_kind(const programs::ModelKind& kind, const programs::FitSettings& settings = {}) {
  return [kind, settings](const BeyondTask& task) {
    const programs::NamedAirframe airframe{task.airframe.airframe_name(), task.airframe.airframe<double>()};
    const std::vector<std::string> absent;
    programs::FitTask fit{airframe, task.split.train, task.split.validation, absent,
                          0,        task.seed,        task.epochs,           settings};
    BeyondTraining result;
    result.model = kind.fit(fit);
    result.best_weights = result.residual_kept = has_residual(result.model->certificate());
    return result;
  };
}

/// The same on rows and their images, as many steps of the optimiser as without them.
Train on_images(const Train& train, const Symmetries& which) {
  return [train, which](const BeyondTask& task) {
    std::mt19937_64 engine(task.seed);
    const SymmetricRows images(task.split.train, task.airframe.airframe<double>(), which, engine);
    const pinnquad::RowSplit split{images.rows(), task.split.validation, task.split.test};
    const auto times = static_cast<int>(images.rows().size() / task.split.train.size());
    return train({split, task.airframe, task.seed, std::max(1, task.epochs / times), task.goes_on});
  };
}

Train on_rigid_body(Slopes slopes) {
  return [slopes](const BeyondTask& task) { return train_structured_on_rigid_body(task, slopes); };
}

}  // namespace

std::vector<BeyondModel> beyond_models() {
  // vanilla and physics-informed are the first two kinds of a recipe
  const std::vector<programs::ModelKind> best = programs::best_recipe().kinds;
  const Train vanilla = of_kind(best[0]);
  const auto structured = [](std::optional<bool> altitude, bool pinned_slopes = false) {
    return of_kind(programs::log_structured(), {false, altitude, pinned_slopes});
  };
  const Train shipped = structured({});
  constexpr Symmetries mirrored{true, false}, turned{true, true};
  return {
      {"none", "commands of the hover, whatever is asked", true, false, evaluate_none},
      {"formula", "Eq. (3) inverted", true, false, evaluate_formula},
      {"inverse", "the vehicle's equations inverted, drag too, no wind, no ground effect", true, false,
       evaluate_inverse},
      {"vanilla", "10 x 25 ReLU on the paper's features, MSE", false, true, vanilla},
      {yardstick, "the same, physics-informed: the paper's network", false, true, of_kind(best[1])},
      {"paper_own_optimiser", "the same, trained as the paper trains: Adam at a constant rate", false, true,
       of_kind(programs::paper_recipe().kinds[1])},
      {"paper_altitude", "the paper's network, shown the altitude", false, true, train_paper_with_altitude},
      {"match", "the paper's network with the loss that asks for equal steps", false, true, train_match},
      {"vanilla_mirrored", "vanilla on rows and their mirror images", false, true, on_images(vanilla, mirrored)},
      {"vanilla_turned", "the same, and all of them under random headings", false, true, on_images(vanilla, turned)},
      {"vanilla_physics", "10 x 25 ReLU on the structured model's features, MSE", false, true,
       train_network_on_physics},
      {"ridge", "affine ridge on the structured model's features, no network", false, false, train_ridge},
      {"structured", "what `train` exports: ridge, slopes above 0, 2 x 32 ReLU without angular acceleration", true,
       true, shipped},
      {"structured_no_altitude", "the same, never shown the altitude", true, true, structured(false)},
      {"structured_altitude", "the same, always shown the altitude", true, true, structured(true)},
      {"structured_pinned", "structured, slopes the airframe's", true, true, structured({}, true)},
      {"structured_mirrored", "structured on rows and their mirror images", true, true, on_images(shipped, mirrored)},
      {"structured_physics", "structured with all three parts of the specific force, no altitude", true, true,
       train_structured_on_physics},
      {"structured_rigid", "structured_physics, the ridge on the rigid body's inverse", true, true,
       on_rigid_body(Slopes::learnt)},
      {"structured_rigid_pinned", "the same, slopes the airframe's", true, true, on_rigid_body(Slopes::pinned)},
      {"path_bounded", "structured, the network shown the angular acceleration, its paths bounded, no altitude", true,
       true, train_path_bounded},
  };
}

std::vector<BeyondModel> chosen_models(const std::vector<BeyondModel>& all, std::vector<std::string> names) {
  if (!names.empty()) names.emplace_back(yardstick);
  return programs::chosen_by_name(
      all, names, [](const BeyondModel& model) { return model.name; }, "--models", "model");
}

}  // namespace study
