// SPDX-License-Identifier: MIT
// A flight stack's controller in words: its reactions and their reasons.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "command_line/in_words.hpp"
#include "command_line/listed.hpp"
#include "model/replayed_row.hpp"
#include "pinnquad/control/autopilot/core_record.hpp"
#include "pinnquad/control/autopilot/neural_controller.hpp"

namespace programs {

/// The numbers that a log holds may be those of a newer core.
inline std::string reaction_name(std::uint8_t number) {
  const auto last = static_cast<std::uint8_t>(pinnquad::autopilot::Reaction::gives_up);
  return number > last ? "reaction " + std::to_string(number)
                       : pinnquad::autopilot::to_string(static_cast<pinnquad::autopilot::Reaction>(number));
}
inline std::string status_name(std::uint8_t number) {
  return number >= pinnquad::status_count ? "status " + std::to_string(number)
                                          : pinnquad::to_string(static_cast<pinnquad::Status>(number));
}

inline constexpr std::array<const char*, 5> core_input_names = {"body rates", "attitude", "position and velocity",
                                                                "set point", "battery voltage"};

/// "attitude, set point" of bits; "none".
inline std::string input_names(std::uint8_t bits) {
  std::string names;
  for (std::size_t i = 0; i < core_input_names.size(); ++i) {
    if ((bits >> i & 1u) != 0) add_to_list(names, core_input_names[i]);
  }
  return names.empty() ? "none" : names;
}

/// "attitude[2] is NaN", "position_m[0] = 2e+06": the first number that no sample has; empty if there is none.
template <std::size_t Count>
std::string bad_numbers(const char* name, const float (&values)[Count]) {
  for (std::size_t i = 0; i < Count; ++i) {
    const auto value = static_cast<double>(values[i]);
    if (std::isfinite(value) && std::fabs(value) <= static_cast<double>(pinnquad::autopilot::most_plausible)) continue;
    const std::string which = std::string(name) + "[" + std::to_string(i) + "]";
    return which + (std::isnan(value) ? " is NaN" : in_words(" = %.3g", value));
  }
  return "";
}

/// Follows the inputs of a controller, so that it can say why one is stale.
class CoreWords {
 public:
  explicit CoreWords(const pinnquad::autopilot::CoreSettings& settings)
      : settings_(settings),
        limits_us_{settings.body_rates_us, settings.attitude_us, settings.local_us, settings.set_point_us,
                   std::uint32_t{pinnquad::autopilot::voltage_limit_us}} {}

  void forget() { inputs_ = {}; }

  /// A sample of input 0 to 4; `what` is wrong with it where it was refused.
  void came(int input, std::uint64_t time_us, pinnquad::Status status, const std::string& what) {
    Input& in = inputs_[static_cast<std::size_t>(input)];
    in.refused = status != pinnquad::Status::ok;
    if (in.refused) {
      in.why = what.empty() ? pinnquad::to_string(status) : what;
    } else {
      in.accepted = true;
      in.time_us = time_us;
    }
  }
  bool refused(int input) const { return inputs_[static_cast<std::size_t>(input)].refused; }

  /// "attitude is 21 ms old (limit 20 ms); body rates are refused: body_rates_rad_s[0] is NaN"; empty if nothing is
  /// stale.
  std::string stale(const pinnquad::autopilot::StepReport& report, std::uint64_t now_us) const {
    std::string words;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      if ((report.stale_inputs >> i & 1u) == 0) continue;
      words += (words.empty() ? "" : "; ") + std::string(core_input_names[i]) + ": " + stale(i, now_us);
    }
    if (report.reaction != pinnquad::autopilot::Reaction::gives_up) return words;
    const bool keeps = report.stale(pinnquad::autopilot::body_rates_bit | pinnquad::autopilot::attitude_bit);
    if (keeps) words += in_words("; commands are kept for %.0f ms at most", 1e-3 * settings_.keep_us);
    if (!keeps && report.stale(pinnquad::autopilot::local_bit))
      words += in_words("; it levels for %.0f ms at most", 1e-3 * settings_.level_us);
    return words;
  }

 private:
  struct Input {
    bool accepted = false, refused = false;
    std::uint64_t time_us = 0;
    std::string why;
  };

  std::string stale(std::size_t input, std::uint64_t now_us) const {
    const Input& in = inputs_[input];
    std::string words = "never came";
    if (in.accepted && in.time_us > now_us) {
      words = in_words("its time stamp is %.1f ms ahead", 1e-3 * static_cast<double>(in.time_us - now_us));
    } else if (in.accepted) {
      words = in_words("%.1f ms old, limit %.0f ms", 1e-3 * static_cast<double>(now_us - in.time_us),
                       1e-3 * static_cast<double>(limits_us_[input]));
    }
    return in.refused ? words + "; the last sample was refused: " + in.why : words;
  }

  pinnquad::autopilot::CoreSettings settings_;
  std::array<Input, 5> inputs_{};
  std::array<std::uint32_t, 5> limits_us_;
};

}  // namespace programs
