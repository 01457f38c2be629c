// SPDX-License-Identifier: MIT
// Why a model did not answer, in words: which feature left the envelope, and by how much; what is NaN; which command is
// absurd.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "command_line/in_words.hpp"
#include "command_line/listed.hpp"
#include "model/replayed_row.hpp"
#include "pinnquad/exported/run_time_features.hpp"
#include "pinnquad/inference/guard.hpp"

namespace programs {

/// A model's features: what they are called, and between which numbers it was trained.
template <class View>
class ReasonOf {
 public:
  using Scalar = typename View::Scalar;
  using FeatureVector = typename View::FeatureVector;

  /// The features must stay where they are.
  ReasonOf(const View& view, const pinnquad::RunTimeFeatures& features) : view_(view), features_(&features) {
    for (int i = 0; i < features.size(); ++i) feature_at_[place(i)] = i;
  }

  /// Of what the network alone came to; `x`: its features. Empty where it answered.
  template <class Report>
  std::string operator()(pinnquad::Status cause, const Report& report, const FeatureVector& x) const {
    using pinnquad::Status;
    switch (cause) {
      case Status::ok: return "";
      case Status::limited: return "commands clipped";
      case Status::not_finite: return not_finite(x);
      case Status::not_unit_quaternion: return "the attitude is no unit quaternion";
      case Status::outside_envelope: return outside(report, x);
      case Status::outside_limits: return absurd(x);
      case Status::output_not_finite: return "the network's commands are NaN or infinite";
      default: return pinnquad::to_string(cause);
    }
  }

  /// Of what stands at a place of X.
  std::string name(int place) const { return std::string(said(place).name); }

  /// "wdot_x = 71.2 rad/s^2 is above 62.9, by 0.13 half-widths of its range"
  std::string beyond(int place, double value, double half_widths) const {
    const auto i = static_cast<std::size_t>(place);
    const std::string of(said(place).unit), unit = of == "1" ? "" : " " + of;
    if (!std::isfinite(value)) return name(place) + (std::isnan(value) ? " is NaN" : " is infinite");
    const auto lower = static_cast<double>(view_.envelope_lower[i]),
               upper = static_cast<double>(view_.envelope_upper[i]);
    const bool below = value < lower;
    return in_words("%s = %.4g%s is %s %.4g, by %.2g half-widths of its range", name(place).c_str(), value,
                    unit.c_str(), below ? "below" : "above", below ? lower : upper, half_widths);
  }

 private:
  const pinnquad::detail::NameAndUnit& said(int place) const {
    return (*features_)[feature_at_[static_cast<std::size_t>(place)]];
  }
  std::size_t place(int feature) const { return static_cast<std::size_t>(View::Features::place(*features_, feature)); }

  std::string not_finite(const FeatureVector& x) const {
    std::string names;
    for (int i = 0; i < features_->size(); ++i) {
      if (!std::isfinite(x[place(i)])) add_to_list(names, std::string((*features_)[i].name));
    }
    return names.empty() ? "an input is NaN or infinite" : "NaN or infinite: " + names;
  }

  template <class Report>
  std::string outside(const Report& report, const FeatureVector& x) const {
    if (report.worst_feature < 0) return "outside the envelope";
    const auto worst = static_cast<std::size_t>(report.worst_feature);
    std::string reason =
        beyond(report.worst_feature, static_cast<double>(x[worst]), static_cast<double>(report.excess[worst]));
    std::string others;
    for (std::size_t i = 0; i < report.excess.size(); ++i) {
      if (i == worst || pinnquad::detail::equal(report.excess[i], Scalar(0))) continue;
      add_to_list(others, name(static_cast<int>(i)));
    }
    return others.empty() ? reason : reason + "; outside too: " + others;
  }

  std::string absurd(const FeatureVector& x) const {
    FeatureVector standardised{};
    view_.input.standardise(x.data(), standardised.data());
    std::array<Scalar, pinnquad::rotor_count> u{};
    view_.forward(standardised.data(), u.data());
    std::string words = "the network's commands are beyond the guard's limits:";
    for (const Scalar command : u) words += in_words(" %.3g", static_cast<double>(command));
    return words;
  }

  View view_;
  const pinnquad::RunTimeFeatures* features_;
  std::array<int, static_cast<std::size_t>(View::Features::size)> feature_at_{};  ///< by its place in X
};

}  // namespace programs
