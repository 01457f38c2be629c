// SPDX-License-Identifier: MIT
// May this model fly? One answer and one wording for every command, page and header: the reason, and what to do next.
#pragma once

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/in_columns.hpp"

namespace programs {

enum class MayFly { in_simulation_and_bench, with_care, no };

inline const char* word_of(MayFly may_fly) {
  switch (may_fly) {
    case MayFly::in_simulation_and_bench: return "fit";
    case MayFly::with_care: return "care";
    case MayFly::no: return "no";
  }
  return "";
}

/// Begins as fit; each doubt makes it worse, none better.
class FlightVerdict {
 public:
  /// `evidence`: what the verdict is made of; of a model that is fit it is why. `subject` goes before it there.
  explicit FlightVerdict(std::string evidence = {}, std::string subject = {})
      : evidence_(std::move(evidence)), subject_(std::move(subject)) {}

  /// `next`: a flight to record or a command to type; that of the worst finding, of equals the first, is shown.
  void care(const std::string& why, const std::string& next) { add(MayFly::with_care, why, next); }
  void refuse(const std::string& why, const std::string& next) { add(MayFly::no, why, next); }
  /// The next step of a model that is fit.
  void then(const std::string& next) {
    if (next_.empty()) next_ = next;
  }

  MayFly may_fly() const { return may_fly_; }
  const std::vector<std::string>& reasons() const { return reasons_; }
  const std::string& evidence() const { return evidence_; }
  const std::string& next() const { return next_; }

  /// "do not fly": the verdict without its reasons.
  const char* short_words() const {
    switch (may_fly_) {
      case MayFly::in_simulation_and_bench: return "fit for simulation and bench";
      case MayFly::with_care: return "fly with care";
      case MayFly::no: return "do not fly";
    }
    return "";
  }
  /// Reasons where there are any, else the evidence.
  std::string why() const {
    std::string text;
    for (const std::string& reason : reasons_) text += (text.empty() ? "" : "; ") + reason;
    return reasons_.empty() ? subject_ + evidence_ : text;
  }
  /// "do not fly: why".
  std::string words() const { return short_words() + (why().empty() ? "" : ": " + why()); }

 private:
  void add(MayFly may_fly, const std::string& why, const std::string& next) {
    if (may_fly > may_fly_) {  // lesser reasons are for the details
      may_fly_ = may_fly;
      reasons_.clear();
      next_ = next;
    }
    if (may_fly == may_fly_) reasons_.push_back(why);
  }

  MayFly may_fly_ = MayFly::in_simulation_and_bench;
  std::string evidence_, subject_, next_;
  std::vector<std::string> reasons_;
};

/// The first lines of a command's answer.
inline std::string verdict_text(const FlightVerdict& verdict) {
  const auto unless_empty = [](const char* name, const std::string& text) {
    return text.empty() ? std::string() : entry(name, text);
  };
  return entry("verdict", verdict.words()) + unless_empty("next", verdict.next()) +
         (verdict.reasons().empty() ? "" : unless_empty("evidence", verdict.evidence()));
}

inline void print_verdict(const FlightVerdict& verdict) { std::fputs(verdict_text(verdict).c_str(), stdout); }

inline nlohmann::json verdict_json(const FlightVerdict& verdict) {
  return {{"may_fly", word_of(verdict.may_fly())}, {"in_words", verdict.words()},    {"why", verdict.why()},
          {"reasons", verdict.reasons()},          {"evidence", verdict.evidence()}, {"next", verdict.next()}};
}

/// The flight that most models lack.
inline constexpr const char* livelier_flight =
    "record 3 minutes or more: quick rolls and pitches, yaw both ways, climbs, your fastest speed (docs/how_to_log.md)";

}  // namespace programs
