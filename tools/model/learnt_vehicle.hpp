// SPDX-License-Identifier: MIT
// A vehicle that was learnt in flight (docs/onboard.md), as files: its model, the airframe that flies, its certificate,
// the slopes with their intervals over time, and a picture of these.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "airframe/toml_writer.hpp"
#include "command_line/in_words.hpp"
#include "page/chart.hpp"
#include "pinnquad/control/onboard/onboard_inverse.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/deploy/learnt_model.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "training/judgement.hpp"

namespace programs {

/// A learner as it was from tick to tick.
template <class Scalar>
class LearntVehicle {
  using Learner = pinnquad::OnboardInverse<Scalar>;

 public:
  explicit LearntVehicle(const pinnquad::Airframe<Scalar>& start) : start_(forward_model(start)) {}

  /// After a tick, of a time from the first one.
  void note(double time_s, const Learner& learner) {
    model_rows_.note(learner);
    const auto second = static_cast<long>(std::floor(time_s));
    bool swapped = false;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& sum = learner.certificate()[k];
      if (sum.forward.theta == last_[k].theta && sum.proven_row == rows_[k]) continue;
      swapped = swapped || rows_seen_;
      if (rows_seen_) {
        const bool back = sum.refused_last == pinnquad::OnboardRule::went_back;
        swaps_.push_back({time_s, k, number(sum.forward.slope()), number(sum.half_width), back ? "went_back" : "none"});
      }
      last_[k] = sum.forward;
      rows_[k] = sum.proven_row;
    }
    rows_seen_ = true;
    if (second == second_ && !swapped) return;
    second_ = second;
    Moment moment;
    moment.time_s = time_s;
    for (std::size_t k = 0; k < 4; ++k) {
      moment.flown[k] = of(learner.certificate()[k]);
      moment.candidate[k] = of(learner.candidate()[k]);
    }
    moments_.push_back(moment);
  }

  /// Into a folder that is there: airframe.toml, learnt.block, learnt.hpp, learnt.json, slopes.csv, slopes.svg. Returns
  /// why there is no model; empty where there is one. `flight`: name of the log. Throws OutputError.
  std::string write(const std::string& folder, const std::string& name, const std::string& flight,
                    const Learner& learner) const {
    write_text(folder + "/airframe.toml", airframe_text(name, learner));
    write_text(folder + "/learnt.json", certificate(learner).dump(2) + "\n");
    write_text(folder + "/slopes.csv", table());
    write_svg(folder + "/slopes.svg", picture());
    try {
      const auto model = learnt_model(learner, name, model_rows_);
      const auto golden = model_rows_.some<Scalar>();
      const pinnquad::Provenance from = learnt_provenance(learner, flight, model_rows_);
      const std::vector<unsigned char> block = model_block(model, golden, from, struct_name);
      write_model_header(folder + "/learnt.hpp", struct_name, model, golden, from);
      pinnquad::write_weight_file(folder + "/learnt.block", block);
    } catch (const std::invalid_argument& refused) {
      return refused.what();
    }
    return {};
  }

  /// The sums that fly at the end, and each swap.
  nlohmann::json certificate(const Learner& learner) const {
    nlohmann::json json = {
        {"rows", learner.rows()},
        {"drag",
         {{"linear_1_s", number(learner.drag().linear_1_s)}, {"quadratic_1_m", number(learner.drag().quadratic_1_m)}}}};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& sum = learner.certificate()[k];
      nlohmann::json& said = json[sum_names[k]];
      said = {{"proven", sum.proven},
              {"slope", number(sum.forward.slope())},
              {"over_start", number(sum.forward.slope()) / number(start_[k].slope())},
              {"half_width", nullptr},
              {"lag_s", number(sum.forward.lag.seconds())},
              {"terms", nlohmann::json::array()},
              {"terms_bound", number(sum.terms_bound)},
              {"gain", number(sum.gain)},
              {"proven_row", sum.proven_row},
              {"refused_last", to_string(sum.refused_last)},
              {"swaps", nlohmann::json::array()}};
      if (sum.proven) said["half_width"] = number(sum.half_width);
      for (const Scalar term : sum.forward.theta) said["terms"].push_back(number(term));
      for (const Swap& swap : swaps_) {
        if (swap.sum != k) continue;
        said["swaps"].push_back(
            {{"time_s", swap.time_s}, {"slope", swap.slope}, {"half_width", swap.half_width}, {"rule", swap.rule}});
      }
    }
    return json;
  }

  /// Slopes over the start's: what flies, its interval, each second's candidate and the swaps; the truth's, where
  /// somebody knows them.
  Chart picture(const std::optional<std::array<double, 4>>& truth = {}) const {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    Chart chart{
        "A vehicle as it is learnt: slopes over the start's",
        "For thrust, roll, pitch and yaw over time: the slope that flies with its interval, the candidates and the "
        "swaps"};
    chart.columns = 2;
    for (std::size_t k = 0; k < 4; ++k) {
      const double start = number(start_[k].slope());
      Panel panel;
      panel.title = sum_names[k];
      panel.x.name = "time, s";
      panel.y.name = "over the start";
      Series flown{"flies", Shape::line, colour::blue}, low{k == 0 ? "interval" : "", Shape::line, colour::muted},
          high{"", Shape::line, colour::muted}, candidates{"candidate", Shape::dots, colour::amber},
          swapped{"swap", Shape::squares, colour::red};
      if (k != 0) flown.name = candidates.name = swapped.name = "";
      low.dashed = high.dashed = true;
      Of before;
      for (const Moment& moment : moments_) {
        const Of& now = moment.flown[k];
        if (!flown.x.empty() && (now.slope < before.slope || now.slope > before.slope)) {  // a step
          flown.add(moment.time_s, before.slope / start);
        }
        flown.add(moment.time_s, now.slope / start);
        const double half = now.proven ? now.half_width / std::fabs(start) : nan;
        low.add(moment.time_s, now.slope / start - half);
        high.add(moment.time_s, now.slope / start + half);
        const double candidate = moment.candidate[k].slope / start;
        if (candidate > 0 && candidate < 4) candidates.add(moment.time_s, candidate);
        before = now;
      }
      for (const Swap& swap : swaps_) {
        if (swap.sum == k) swapped.add(swap.time_s, swap.slope / start);
      }
      const std::string rule = before.rule == std::string(to_string(pinnquad::OnboardRule::none))
                                   ? std::string()
                                   : std::string("; refused last: ") + before.rule;
      panel.note = (before.proven ? in_words("%.3g +- %.1f %%", before.slope / start,
                                             100 * before.half_width / std::fabs(before.slope))
                                  : std::string("the start's")) +
                   rule;
      panel.series = {low, high, candidates, flown, swapped};
      if (truth && !flown.x.empty()) {
        Series known{k == 0 ? "truth" : "", Shape::line, colour::green};
        known.dashed = true;
        for (const double end : {flown.x.front(), flown.x.back()}) known.add(end, (*truth)[k] / start);
        panel.series.insert(panel.series.begin(), known);
      }
      chart.panels.push_back(panel);
    }
    return chart;
  }

 private:
  static constexpr const char* struct_name = "LearntModel";

  struct Of {
    bool proven = false;
    double slope = 0, half_width = 0;
    const char* rule = "";
  };
  struct Moment {
    double time_s = 0;
    std::array<Of, 4> flown, candidate;
  };
  struct Swap {
    double time_s;
    std::size_t sum;
    double slope, half_width;
    const char* rule;
  };

  static double number(Scalar value) { return static_cast<double>(value); }
  static Of of(const pinnquad::detail::OnboardSum<Scalar>& sum) {
    return {sum.proven, number(sum.forward.slope()), number(sum.half_width), to_string(sum.refused_last)};
  }
  static void write_text(const std::string& path, const std::string& text) {
    pinnquad::AtomicFile file(path);
    file.stream() << text;
    file.commit();
  }

  std::string airframe_text(const std::string& name, const Learner& learner) const {
    std::string proven;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& sum = learner.certificate()[k];
      proven += std::string("# ") + sum_names[k] +
                (sum.proven ? in_words(": learnt, %.4g of the start, +- %.1f %%\n",
                                       number(sum.forward.slope()) / number(start_[k].slope()),
                                       100 * number(sum.half_width) / std::fabs(number(sum.forward.slope())))
                            : std::string(": the start's; refused last: ") + to_string(sum.refused_last) + "\n");
    }
    return "# Learnt in flight (learnt.json has the certificate).\n" + proven +
           airframe_toml({name + ", learnt", pinnquad::airframe_in<double>(learner.airframe())});
  }

  std::string table() const {
    std::string text = "t";
    for (const char* name : sum_names) {
      for (const char* what : {"proven", "slope", "half_width", "candidate", "candidate_half_width", "refused_last"}) {
        text += std::string(",") + name + "_" + what;
      }
    }
    text += "\n";
    for (const Moment& moment : moments_) {
      text += pinnquad::number_text(moment.time_s);
      for (std::size_t k = 0; k < 4; ++k) {
        const Of &flown = moment.flown[k], &candidate = moment.candidate[k];
        text += std::string(flown.proven ? ",1," : ",0,") + pinnquad::number_text(flown.slope) + "," +
                (flown.proven ? pinnquad::number_text(flown.half_width) : std::string()) + "," +
                pinnquad::number_text(candidate.slope) + "," + pinnquad::number_text(candidate.half_width) + "," +
                flown.rule;
      }
      text += "\n";
    }
    return text;
  }

  pinnquad::detail::ForwardModel<Scalar> start_, last_{};
  std::array<std::uint32_t, 4> rows_{};
  bool rows_seen_ = false;
  long second_ = -1;
  std::vector<Moment> moments_;
  std::vector<Swap> swaps_;
  pinnquad::LearntRows model_rows_;
};

}  // namespace programs
