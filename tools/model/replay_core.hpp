// SPDX-License-Identifier: MIT
// The flight stacks' controller (pinnquad/control/autopilot/neural_controller.hpp) over what it logged: each tick's
// inputs go in as they came, what it answers is compared with what was logged.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line/in_words.hpp"
#include "model/core_words.hpp"
#include "model/flight_stack.hpp"
#include "model/recorded_effects.hpp"
#include "model/replay_reason.hpp"
#include "pinnquad/control/onboard/onboard_inverse.hpp"

namespace programs {

struct CoreReplayOptions {
  pinnquad::autopilot::CoreSettings settings;
  double tolerance = 1e-5;  ///< of a command
};

/// Runs records of one core, in their order, through controllers of the airframe of `models`, which is the same for
/// all.
class CoreReplay {
 public:
  CoreReplay() = default;
  CoreReplay(const CoreReplay&) = delete;
  CoreReplay& operator=(const CoreReplay&) = delete;
  virtual ~CoreReplay() = default;

  /// One tick. `model`: which of the models flew, or none.
  virtual ReplayedRow run(const pinnquad::autopilot::CoreRecord& record, std::optional<std::size_t> model,
                          Replayed& replayed) = 0;
  /// The vehicle as it is learnt, after the tick; null where its past is not in the log.
  virtual const pinnquad::OnboardInverse<float>* learner() const = 0;
};

/// `models` must stay where they are. Throws std::invalid_argument for a model that no flight stack flies, for some of
/// different features, for an effect or limits of trust that are not known.
std::unique_ptr<CoreReplay> core_replay(const std::vector<pinnquad::BlockModel>& models,
                                        const pinnquad::Airframe<float>& airframe, const CoreReplayOptions& options);

namespace detail {

/// `Trust`: as a NeuralController's; it has a static set().
template <class FeatureSet, class Trust>
class CoreReplayOf : public CoreReplay {
  using Shape = RunTimeShape<FeatureSet, float>;
  using View = RunTimeView<FeatureSet, float>;
  using Vehicle = pinnquad::Quadrotor<float, RecordedEffects>;
  using Controller =
      pinnquad::autopilot::NeuralController<Shape, View, Vehicle, Trust, pinnquad::OnboardInverse<float>>;
  using Record = pinnquad::autopilot::CoreRecord;
  using Features = typename Shape::Features;
  static constexpr bool trusts = !std::is_void_v<Trust>;
  static constexpr std::uint8_t voltage_bit = pinnquad::autopilot::voltage_bit;

 public:
  CoreReplayOf(const std::vector<pinnquad::BlockModel>& models, const pinnquad::Airframe<float>& airframe,
               const CoreReplayOptions& options)
      : models_(models),
        vehicle_(airframe, {}, recorded_effects(options.settings)),
        options_(options),
        words_(options.settings) {
    const pinnquad::RunTimeFeatures& features = models.front().features();
    FeatureSet::of = &features;
    asks_for_voltage_ = features.column_count() > 0;
    has_past_ = features.window().taps > 1;
    models.front().with([this](const auto& own) { this->take_trust(own); });
    for (const pinnquad::BlockModel& model : models) {
      if (model.feature_names() != models.front().feature_names()) {
        throw std::invalid_argument("--model: " + models.front().path() + " and " + model.path() +
                                    " differ in features");
      }
      model.with([&](const auto& own) { take(model, own); });
    }
    restart();
  }

  ReplayedRow run(const Record& record, std::optional<std::size_t> model, Replayed& replayed) override {
    take_gap(record);
    take_model(model);
    take_jump(record);
    if (record.timestamp < bias_known_us_) controller_->give_biases(record);
    ReplayedRow row;
    row.row = record.tick;
    row.time_s = static_cast<double>(record.timestamp) / 1e6;
    take_inputs(record, record.came);
    pinnquad::autopilot::StepReport report;
    pinnquad::Commands<float> commands{};
    if ((record.learnt & Record::seen_flight) == 0) learner_unknown_ = false;  // there is nothing to know
    const auto learning = pinnquad::autopilot::learning_of(record.learning);
    controller_->situation({record.drives_motors != 0, record.landed != 0, learning});
    if (record.asked != 0) {
      controller_->step(record.timestamp, commands, report);
    } else {
      controller_->skip(record.timestamp);
    }
    if (!asks_for_voltage_) report.stale_inputs = static_cast<std::uint8_t>(report.stale_inputs & ~voltage_bit);
    describe(record, report, commands, model, row);
    const bool known = is_known(record, report);
    if (known) {
      ++replayed.compared;
      compare(record, report, row, replayed);
    }
    if (!report.stale(pinnquad::autopilot::set_point_bit)) holding_unknown_ = false;
    if (report.reaction <= pinnquad::autopilot::Reaction::levels) answer_unknown_ = false;
    // each tick is judged by itself: the next one starts from what this one logged
    controller_->resume(record);
    last_tick_ = record.tick;
    return row;
  }

  const pinnquad::OnboardInverse<float>* learner() const override {
    return learner_unknown_ ? nullptr : &controller_->onboard();
  }

 private:
  template <class Scalar>
  void take(const pinnquad::BlockModel& model, const pinnquad::RunTimeModel<Scalar>& own) {
    if constexpr (std::is_same_v<Scalar, float>) {  // CoreFeatures::fits() has refused others
      const View view(own);
      View::know(model.data(), view);
      reasons_.emplace_back(view, own.features());
    }
  }
  template <class Scalar>
  void take_trust([[maybe_unused]] const pinnquad::RunTimeModel<Scalar>& own) {
    if constexpr (std::is_same_v<Scalar, float> && trusts) {
      if (options_.settings.distance_limit > 0) has_trust_ = Trust::set(own);
    }
  }
  static pinnquad::Vector3<float> vector(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

  void restart() {
    controller_.emplace(vehicle_, options_.settings);
    flown_.reset();
    words_.forget();
    refused_base_ = 0;
    refused_base_known_ = true;
    unknown_inputs_ = 0;
    bias_known_us_ = 0;
    holding_unknown_ = answer_unknown_ = past_unknown_ = learner_unknown_ = false;
  }

  /// Ticks that are missing: the controller is put together again from what the record says came last.
  void take_gap(const Record& record) {
    if (record.tick == last_tick_ + 1) return;
    const bool from_the_start = record.tick == 1;
    restart();
    if (from_the_start) return;
    holding_unknown_ = answer_unknown_ = learner_unknown_ = true;
    past_unknown_ = has_past_;
    const typename Controller::Learner& learner = controller_->learner();
    bias_known_us_ = record.timestamp + learner.motion().settles_us();
    window_known_us_ = bias_known_us_ + 2 * learner.trust().window_us(learner.motion().period_us());
    alarm_known_us_ = record.timestamp + static_cast<std::uint64_t>(1e6f * Controller::Learner::clear_s);
    controller_->resume(record);
    take_inputs(record, static_cast<std::uint8_t>(~record.came & 31));
    for (int i = 0; i < 5; ++i) {  // what was refused hides the good one before it
      if (words_.refused(i)) unknown_inputs_ = static_cast<std::uint8_t>(unknown_inputs_ | (1 << i));
    }
    refused_base_ = record.refused_samples;
    refused_base_known_ = false;
  }

  void take_jump(const Record& record) {
    const pinnquad::autopilot::LocalState by{vector(record.jump_position_m), vector(record.jump_velocity_m_s)};
    if (!by.position_m.isZero(0) || !by.velocity_m_s.isZero(0) || std::fabs(record.jump_yaw_rad) > 0) {
      controller_->jump(by, record.jump_yaw_rad);
      past_unknown_ = false;  // it is forgotten
    }
  }

  void take_model(std::optional<std::size_t> model) {
    if (!model || flown_ == model) return;
    const pinnquad::BlockModel& flies = models_[*model];
    static_cast<void>(controller_->offer_model(flies.data(), flies.size()));
    flown_ = model;
  }

  void take_inputs(const Record& r, std::uint8_t which) {
    using pinnquad::Status;
    const auto note = [&](int input, std::uint64_t time_us, Status status, const std::string& what) {
      words_.came(input, time_us, status, what);
      if (status == Status::ok) unknown_inputs_ = static_cast<std::uint8_t>(unknown_inputs_ & ~(1 << input));
    };
    if ((which & pinnquad::autopilot::body_rates_bit) != 0) {
      note(0, r.body_rates_us, controller_->body_rates(r.body_rates_us, vector(r.body_rates_rad_s)),
           bad_numbers("body_rates_rad_s", r.body_rates_rad_s));
    }
    if ((which & pinnquad::autopilot::attitude_bit) != 0) {
      const pinnquad::Quaternion<float> q{r.attitude[0], r.attitude[1], r.attitude[2], r.attitude[3]};
      const Status status = controller_->attitude(r.attitude_us, q);
      note(1, r.attitude_us, status,
           status == Status::not_unit_quaternion
               ? in_words("its norm is %.6g", std::sqrt(static_cast<double>(pinnquad::squared_norm(q))))
               : bad_numbers("attitude", r.attitude));
    }
    if ((which & pinnquad::autopilot::local_bit) != 0) {
      const std::string position = bad_numbers("position_m", r.position_m);
      note(2, r.local_us, controller_->local(r.local_us, {vector(r.position_m), vector(r.velocity_m_s)}),
           position.empty() ? bad_numbers("velocity_m_s", r.velocity_m_s) : position);
    }
    if ((which & pinnquad::autopilot::set_point_bit) != 0) {
      pinnquad::TrajectoryPoint<float> wanted;
      wanted.position_m = vector(r.wanted_position_m);
      wanted.velocity_m_s = vector(r.wanted_velocity_m_s);
      wanted.acceleration_m_s2 = vector(r.wanted_acceleration_m_s2);
      wanted.jerk_m_s3 = vector(r.wanted_jerk_m_s3);
      wanted.yaw_rad = r.wanted_yaw_rad;
      wanted.yaw_rate_rad_s = r.wanted_yaw_rate_rad_s;
      note(3, r.set_point_us, controller_->set_point(r.set_point_us, wanted), "it asks for nothing, or beyond 1e6");
    }
    if ((which & voltage_bit) != 0 && asks_for_voltage_) {
      note(4, r.voltage_us, controller_->battery_voltage(r.voltage_us, r.battery_voltage),
           in_words("battery_voltage = %.3g", static_cast<double>(r.battery_voltage)));
    }
  }

  void describe(const Record& record, const pinnquad::autopilot::StepReport& report,
                const pinnquad::Commands<float>& commands, std::optional<std::size_t> model, ReplayedRow& row) {
    using pinnquad::autopilot::Reaction;
    row.status = report.status;
    row.cause = report.cause;
    row.reaction = pinnquad::autopilot::to_string(report.reaction);
    row.excess = static_cast<double>(report.worst_excess);
    if (report.worst_feature >= 0) row.feature = reasons_.front().name(report.worst_feature);
    if (report.reaction != Reaction::gives_up) {
      for (std::size_t i = 0; i < commands.size(); ++i) row.commands[i] = static_cast<double>(commands[i]);
    }
    for (std::size_t i = 0; i < 4; ++i) row.logged[i] = static_cast<double>(record.commands[i]);
    const bool asked_network = report.reaction <= Reaction::levels;
    const bool learns = controller_->learning() != pinnquad::autopilot::Learning::off;
    if (asked_network) {
      row.answerer = report.status == pinnquad::Status::fell_back ? Answerer::analytic_inverse
                     : learns                                     ? Answerer::learner
                                                                  : Answerer::model;
    }
    if (record.asked == 0) {
      row.answerer = Answerer::not_asked;
      row.state = "is not asked";
      row.reason = "off, or flown by hand";
      return;
    }
    row.state = row.reaction;
    if (asked_network) {
      row.state += row.answerer == Answerer::model ? ", model"
                   : row.answerer == Answerer::learner
                       ? ", learner"
                       : std::string(", analytic inverse (") + to_string(report.cause) + ")";
    }
    if (model && models_.size() > 1) {
      row.state += " [" + std::filesystem::path(models_[*model].path()).filename().string() + "]";
    }
    row.reason = words_.stale(report, record.timestamp);
    if (!model) row.reason = "no model was accepted yet";
    const bool has_cause = report.cause != pinnquad::Status::ok || report.status != pinnquad::Status::ok;
    if (model && has_cause) {
      const std::string distrust = distrust_in_words(report);
      const std::string why =
          distrust.empty() ? reasons_[*model](report.cause, Excess(report), Features::template last<float>) : distrust;
      row.reason += (row.reason.empty() || why.empty() ? "" : "; ") + why;
      if (!pinnquad::has_output(report.status)) {
        row.reason += std::string("; the analytic inverse declines too: ") + pinnquad::to_string(report.status);
      }
    }
  }

  std::string distrust_in_words(const pinnquad::autopilot::StepReport& report) const {
    if (report.cause == pinnquad::Status::distrusted && controller_->trusted()) {
      return "the bias stood at its bound: it does not carry what the model lacks";
    }
    if constexpr (trusts) {
      if (report.cause == pinnquad::Status::distrusted) {
        return in_words("command residual %.4g, limit %.4g, cleared at %.4g",
                        static_cast<double>(controller_->command_residual()), Trust::command_residual_limit,
                        Trust::command_residual_cleared);
      }
      if (report.cause == pinnquad::Status::outside_distribution) {
        return in_words("squared distance %.4g, limit %.4g", static_cast<double>(report.squared_distance),
                        Trust::squared_distance_limit);
      }
    }
    return "";
  }

  /// A step's report as that of a guard: of the features outside it knows the worst alone.
  struct Excess {
    std::array<float, static_cast<std::size_t>(Features::size)> excess{};
    int worst_feature;
    explicit Excess(const pinnquad::autopilot::StepReport& report) : worst_feature(report.worst_feature) {
      if (worst_feature >= 0) excess[static_cast<std::size_t>(worst_feature)] = report.worst_excess;
    }
  };

  /// False behind a gap, as long as what the core answered may depend on what was not logged.
  bool is_known(const Record& record, const pinnquad::autopilot::StepReport& report) const {
    using pinnquad::autopilot::Reaction;
    if (record.asked == 0) return true;
    if (unknown_inputs_ != 0 || past_unknown_) return false;
    if (learner_unknown_ && record.learning != 0) return false;
    const auto logged = static_cast<Reaction>(record.reaction);
    const bool distrusts = report.cause == pinnquad::Status::distrusted;
    const bool distrusted = record.cause == static_cast<std::uint8_t>(pinnquad::Status::distrusted);
    if (distrusts != distrusted && record.timestamp < alarm_known_us_) return false;
    if (holding_unknown_ && (logged == Reaction::holds_position || report.reaction == Reaction::holds_position))
      return false;
    return !answer_unknown_ || (logged <= Reaction::levels && report.reaction <= Reaction::levels);
  }

  void compare(const Record& record, const pinnquad::autopilot::StepReport& report, ReplayedRow& row,
               Replayed& replayed) {
    using pinnquad::Status;
    const auto say = [&row](const std::string& text) { row.differs += (row.differs.empty() ? "" : "; ") + text; };
    const std::string reaction = reaction_name(record.reaction), status = status_name(record.status),
                      cause = status_name(record.cause);
    if (reaction != pinnquad::autopilot::to_string(report.reaction))
      say("it " + row.reaction + ", logged: " + reaction);
    if (status != pinnquad::to_string(report.status)) {
      say(std::string("status ") + pinnquad::to_string(report.status) + ", logged " + status);
    }
    if (cause != pinnquad::to_string(report.cause)) {
      say(std::string("the network came to ") + pinnquad::to_string(report.cause) + ", logged " + cause);
    }
    if (record.stale_inputs != report.stale_inputs) {
      say("stale: " + input_names(report.stale_inputs) + ", logged: " + input_names(record.stale_inputs));
    }
    const std::uint32_t refused = controller_->refused_samples();
    if (!refused_base_known_) {
      refused_base_ = record.refused_samples - refused;
      refused_base_known_ = true;
    }
    if (refused + refused_base_ != record.refused_samples) {
      say(in_words("%u samples refused, logged %u", refused + refused_base_, record.refused_samples));
      refused_base_ = record.refused_samples - refused;
    }
    compare_biases(record, say);
    if (!learner_unknown_ && controller_->learnt() != record.learnt) {
      say(in_words("learnt %u, logged %u", unsigned{controller_->learnt()}, unsigned{record.learnt}));
    }
    if (has_trust_ && record.timestamp >= window_known_us_) compare_trust(record, say);
    for (std::size_t i = 0; i < 4; ++i) {
      const double mine = row.commands[i], theirs = row.logged[i];
      const bool same = std::isnan(mine) ? std::isnan(theirs) : std::fabs(mine - theirs) <= options_.tolerance;
      if (!same) say(in_words("u%zu %.7g, logged %.7g", i + 1, mine, theirs));
    }
    if (!row.differs.empty() && at_the_edge(record, report)) {
      ++replayed.at_the_edge;
      row.differs.clear();
    }
  }

  template <class Say>
  void compare_biases(const Record& record, const Say& say) {
    constexpr float rounding = 1e-5f, rounding_m_s2 = 1e-4f;
    const auto compare = [&say](const char* name, std::size_t i, float mine, float logged, float most) {
      if (std::fabs(mine - logged) <= most) return;
      say(in_words("%s[%zu] %.6g, logged %.6g", name, i, static_cast<double>(mine), static_cast<double>(logged)));
    };
    const auto &own = controller_->bias(), &analytic = controller_->analytic_bias();
    for (std::size_t k = 0; k < own.sums().size(); ++k) {
      compare("bias_sums", k, own.sums()[k], record.bias_sums[k], rounding);
      compare("analytic_bias_sums", k, analytic.sums()[k], record.analytic_bias_sums[k], rounding);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      compare("bias_across_m_s2", i, analytic.across_m_s2()[Eigen::Index(i)], record.bias_across_m_s2[i],
              rounding_m_s2);
    }
  }

  template <class Say>
  void compare_trust(const Record& record, const Say& say) {
    constexpr float rounding = 1e-5f;
    const float residual = controller_->command_residual();
    if (!(std::fabs(residual - record.innovation) <= rounding)) {
      say(in_words("command residual %.6g, logged %.6g", static_cast<double>(residual),
                   static_cast<double>(record.innovation)));
    }
    if (controller_->trusted() != (record.trusted != 0)) {
      say(std::string("the model is ") + (controller_->trusted() ? "trusted" : "distrusted") + ", logged otherwise");
    }
  }

  /// In the envelope here, just outside it there, or the other way round: rounding of another machine.
  static bool at_the_edge(const Record& record, const pinnquad::autopilot::StepReport& report) {
    using pinnquad::Status;
    constexpr float rounding = 1e-5f;
    const auto logged = static_cast<Status>(record.cause);
    const bool one_side = (report.cause == Status::outside_envelope) != (logged == Status::outside_envelope);
    const bool answered = report.reaction <= pinnquad::autopilot::Reaction::levels &&
                          record.reaction == static_cast<std::uint8_t>(report.reaction);
    return one_side && answered && record.stale_inputs == report.stale_inputs &&
           (report.cause == Status::outside_envelope ? report.worst_excess : record.envelope_excess) <= rounding;
  }

  const std::vector<pinnquad::BlockModel>& models_;
  Vehicle vehicle_;
  CoreReplayOptions options_;
  bool asks_for_voltage_ = false, has_past_ = false;
  bool has_trust_ = false;  ///< the core that flew had limits, and the block has them
  CoreWords words_;
  std::vector<ReasonOf<View>> reasons_;  ///< of each model
  std::optional<Controller> controller_;
  std::optional<std::size_t> flown_;
  std::uint32_t last_tick_ = 0;
  std::uint64_t bias_known_us_ = 0;    ///< behind a gap: from then on its flown motion is that of the core
  std::uint64_t window_known_us_ = 0;  ///< the same of the windows of the command residual
  std::uint64_t alarm_known_us_ = 0;   ///< the same of how long its bias had stood at its bound
  std::uint32_t refused_base_ = 0;
  bool refused_base_known_ = true;
  std::uint8_t unknown_inputs_ = 0;  ///< behind a gap: bits of inputs of which the last good sample is not known
  bool holding_unknown_ = false, answer_unknown_ = false;
  bool learner_unknown_ = false;  ///< behind a gap: what was learnt before it
  bool past_unknown_ = false;  ///< behind a gap: which motions the window is made of, until the core has forgotten them
};

}  // namespace detail
}  // namespace programs
