// SPDX-License-Identifier: MIT
// The claims of the paper's Discussions 1-5 as data: what is claimed, by which rule it is judged, on which comparisons.
// A verdict is computed from the rows.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "report/verdicts.hpp"

namespace programs {

/// Columns of a claim's figures: two figures and what lies between them.
struct ClaimColumns {
  const char* from;
  const char* to;
  const char* change;
};

/// One claim: paraphrased, with its rule in words and as a function of the study.
struct Claim {
  std::string id;
  int discussion;
  std::string statement;
  std::string rule;
  Judged (*judge)(const Study&);
  ClaimColumns columns = {"baseline", "candidate", "change"};
};

using JudgedClaims = std::vector<std::pair<Claim, Judged>>;

/// Every claim of Discussions 1-5 that figures can decide, in the paper's order.
inline std::vector<Claim> paper_claims() {
  const std::string cells = detail::cells_rule;
  const std::string one_training =
      ". Models 9 and 10 are the trainings of 7 and 8, judged on more rows: one piece of evidence";
  const std::string all_hold = "Reproduced: every condition holds. In part: some do. Else not reproduced";
  return {
      {"1.1",
       1,
       "Every network, vanilla or physics-informed, predicts commands at least ten times better than the linearized "
       "model.",
       "reproduced: the error of model 1 is at least 10 times the mean error of each of models 2, 3, 4. In part: of "
       "some, or every network is better by less. Else not reproduced",
       detail::judge_magnitude,
       {"network", "linearized", "factor"}},
      {"1.2",
       1,
       "The linearized model's ellipses lie closer to the target's than those of the networks: poor in error, good in "
       "slope.",
       "conditions: the angle difference of model 1 is below the mean of each of models 2, 3, 4 about each axis. " +
           all_hold,
       detail::judge_linearized_angles,
       {"network", "linearized", "change"}},
      {"2.1", 2,
       "The physics-informed networks (3: constant weight, 4: annealed) have a lower error than the vanilla network "
       "(2).",
       cells,
       [](const Study& s) {
         return detail::judge_errors(s, {{2, 3}, {2, 4}});
       }},
      {"2.2", 2, "Cyclical annealing (4) lowers the error further than a constant weight (3).", cells,
       [](const Study& s) {
         return detail::judge_errors(s, {{3, 4}});
       }},
      {"2.3", 2,
       "The ellipses of the vanilla network (2) deviate more from the target's than those of the physics-informed "
       "network (4).",
       cells,
       [](const Study& s) {
         return detail::judge_angles(s, {{2, 4}});
       }},
      {"3.1", 3, "The physics-informed network gains from batch norm (6 against 4).", cells,
       [](const Study& s) {
         return detail::judge_errors(s, {{4, 6}});
       }},
      {"3.2", 3, "With annealing and batch norm, model 6 is the best on D1.",
       "reproduced: model 6 is better (lower mean error, p < 0.05) than each of models 2 to 5. In part: its mean error "
       "is the lowest. Else not reproduced",
       detail::judge_best_model},
      {"3.3",
       3,
       "The vanilla network with batch norm (5) comes close to model 6: both are near saturation.",
       "reproduced: the mean error of model 5 is at most 10 % above that of model 6. Else not reproduced",
       detail::judge_competitive,
       {"model 6", "model 5", "excess"}},
      {"4.1", 4,
       "On the reduced set the physics-informed networks have a lower error than the vanilla ones (8 against 7, 10 "
       "against 9).",
       cells + one_training,
       [](const Study& s) {
         return detail::judge_errors(s, {{7, 8}, {9, 10}});
       }},
      {"4.2",
       4,
       "That advantage is more pronounced than on the full set: physics helps most where data is scarce.",
       "conditions: the relative gain of 8 against 7, and of 10 against 9, exceeds that of 6 against 5. " + all_hold +
           one_training,
       detail::judge_larger_gain,
       {"change, full set", "change, reduced set", "difference"}},
      {"4.3", 4,
       "On the reduced set the physics-informed networks are also more consistent with physics (ellipse angles).",
       cells + one_training,
       [](const Study& s) {
         return detail::judge_angles(s, {{7, 8}, {9, 10}});
       }},
      {"4.4",
       4,
       "All networks lose accuracy when trained on the reduced set.",
       "conditions: the mean errors of 7 and 9 exceed that of 5, those of 8 and 10 that of 6. " + all_hold,
       detail::judge_degradation,
       {"full set", "reduced set", "change"}},
      {"5.1", 5,
       "With ground effect (D2) the physics-informed network (12) has a lower error than the vanilla one (11).", cells,
       [](const Study& s) {
         return detail::judge_errors(s, {{11, 12}});
       }},
      {"5.2", 5,
       "With periodic wind (D3) the physics-informed network (14) has a lower error than the vanilla one (13).", cells,
       [](const Study& s) {
         return detail::judge_errors(s, {{13, 14}});
       }},
      {"5.3", 5,
       "With ground effect (D2) the physics-informed network is more consistent with physics (ellipse angles).", cells,
       [](const Study& s) {
         return detail::judge_angles(s, {{11, 12}});
       }},
      {"5.4", 5,
       "With periodic wind (D3) the physics-informed network is more consistent with physics (ellipse angles).", cells,
       [](const Study& s) {
         return detail::judge_angles(s, {{13, 14}});
       }},
  };
}

/// All claims with their verdicts. Below six seeds there is neither a yes nor a no. A step for each.
inline JudgedClaims judge_claims(const Study& study, const Step& step) {
  JudgedClaims list;
  for (Claim& claim : paper_claims()) {
    Judged judged = claim.judge(study);
    const bool too_few = judged.seeds < fewest_seeds;
    if (too_few && judged.verdict != Verdict::not_judged) judged.verdict = Verdict::undecided;
    list.emplace_back(std::move(claim), std::move(judged));
    step();
  }
  return list;
}

inline std::size_t count_verdicts(const JudgedClaims& claims, Verdict verdict) {
  std::size_t count = 0;
  for (const auto& [claim, judged] : claims) count += judged.verdict == verdict ? 1 : 0;
  return count;
}

}  // namespace programs
