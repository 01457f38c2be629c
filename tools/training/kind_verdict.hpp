// SPDX-License-Identifier: MIT
// The verdict on a kind of model beside the simpler ones, by paired tests over held-out flights. A model that is worse
// than a simpler one, or no better, is no success; with too few flights to tell, that is what is said.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "command_line/in_words.hpp"
#include "pinnquad/evaluation/paired_test.hpp"
#include "training/judged_kinds.hpp"

namespace programs {

enum class Standing {
  reference,       ///< nothing simpler is there
  success,         ///< better than each simpler kind, and than the mean of the held-out commands
  undecided,       ///< lower errors, but chance could make them
  no_better,       ///< a simpler kind's error is as low or lower, chance or not
  worse,           ///< a simpler kind is better, beyond chance
  worse_than_mean  ///< answering with the mean of the held-out commands would be better
};

inline const char* word_of(Standing standing) {
  switch (standing) {
    case Standing::reference: return "reference";
    case Standing::success: return "success";
    case Standing::undecided: return "undecided";
    case Standing::no_better: return "no better";
    case Standing::worse: return "worse";
    case Standing::worse_than_mean: return "worse than the mean";
  }
  return "";
}

/// Below it a difference is none of chance.
inline constexpr double decisive_p = 0.05;

/// Pairs that a two-sided exact test needs for a p below 0.05: 2^(1-n).
inline constexpr std::size_t fewest_pairs = 6;

/// A kind against a simpler one; errors are root mean squares, lower is better.
struct AgainstSimpler {
  std::size_t simpler = 0;                          ///< of JudgedKinds::kinds
  pinnquad::PairedComparison flights;               ///< a pair per held-out flight: means over the seeds
  std::optional<pinnquad::PairedComparison> seeds;  ///< a pair per seed: means over the flights; of seeded kinds
  Standing standing = Standing::undecided;
};

struct KindVerdict {
  Standing standing = Standing::reference;
  std::string sentence;
  std::vector<AgainstSimpler> against;  ///< in the order of the table
};

namespace detail {

/// compare_paired() of the pairs that are finite; no pairs: a comparison of none, which decides nothing.
inline pinnquad::PairedComparison compare_finite(const std::vector<double>& candidate,
                                                 const std::vector<double>& baseline) {
  std::vector<double> a, b;
  for (std::size_t i = 0; i < candidate.size(); ++i) {
    if (!std::isfinite(candidate[i] - baseline[i])) continue;
    a.push_back(candidate[i]);
    b.push_back(baseline[i]);
  }
  return a.empty() ? pinnquad::PairedComparison{} : pinnquad::compare_paired(a, b);
}

inline Standing standing_of(const pinnquad::PairedComparison& flights) {
  if (flights.pairs == 0) return Standing::undecided;
  const bool beyond_chance = flights.p_value < decisive_p;
  if (flights.mean_difference < 0) return beyond_chance ? Standing::success : Standing::undecided;
  return beyond_chance && flights.losses > flights.wins ? Standing::worse : Standing::no_better;
}

/// Root mean square errors over all flights, seed by seed; of a closed form the same for each of the other's seeds.
inline std::vector<double> error_of_seeds(const JudgedKind& kind, std::size_t seeds) {
  std::vector<double> values = per_seed(kind, [](const JudgedFit& fit) {
    double sum = 0;
    for (const double error : fit.by_flight) sum += error;
    return sum / static_cast<double>(fit.by_flight.size());
  });
  if (!kind.kind.seeded) values.assign(seeds, values.front());
  return values;
}

inline AgainstSimpler compare_kinds(const JudgedKinds& judged, std::size_t candidate, std::size_t simpler) {
  const JudgedKind &a = judged.kinds[candidate], &b = judged.kinds[simpler];
  AgainstSimpler result;
  result.simpler = simpler;
  result.flights = compare_finite(error_of_flights(a), error_of_flights(b));
  if (a.kind.seeded && (!b.kind.seeded || a.seeds == b.seeds)) {
    result.seeds = compare_finite(error_of_seeds(a, a.seeds.size()), error_of_seeds(b, a.seeds.size()));
  }
  result.standing = standing_of(result.flights);
  return result;
}

inline std::string change_text(const AgainstSimpler& against) {
  const pinnquad::PairedComparison& c = against.flights;
  return in_words("error %+.1f %%, lower on %zu of %zu held-out flights, p = %.2g", 100 * c.relative_difference, c.wins,
                  c.pairs, c.p_value);
}

inline std::string seeds_text(const AgainstSimpler& against) {
  if (!against.seeds || against.seeds->pairs == 0) return {};
  return "; lower from " + std::to_string(against.seeds->wins) + " of " + std::to_string(against.seeds->pairs) +
         " seeds";
}

inline double r2_of(const JudgedKind& kind) {
  return pinnquad::summarize(per_seed(kind, [](const JudgedFit& fit) { return mean_over_motors(fit.errors.r2); })).mean;
}

}  // namespace detail

/// Simpler kinds of `candidate`: those before it that see no more of the motion than it does, and were judged.
inline std::vector<std::size_t> simpler_kinds(const JudgedKinds& judged, std::size_t candidate) {
  std::vector<std::size_t> simpler;
  for (std::size_t k = 0; k < candidate; ++k) {
    if (judged.kinds[k].applicable() && judged.kinds[k].kind.reach <= judged.kinds[candidate].kind.reach)
      simpler.push_back(k);
  }
  return simpler;
}

/// The verdict on an applicable kind.
inline KindVerdict verdict_on_kind(const JudgedKinds& judged, std::size_t candidate) {
  KindVerdict verdict;
  const AgainstSimpler* worst = nullptr;  // what stands most against it; of equals the one with the lowest error
  for (const std::size_t simpler : simpler_kinds(judged, candidate)) {
    verdict.against.push_back(detail::compare_kinds(judged, candidate, simpler));
  }
  if (verdict.against.empty()) {
    verdict.sentence = "what the others are compared with";
    return verdict;
  }
  for (const AgainstSimpler& against : verdict.against) {
    if (worst == nullptr || against.standing > worst->standing ||
        (against.standing == worst->standing && against.flights.mean_difference > worst->flights.mean_difference)) {
      worst = &against;
    }
  }
  verdict.standing = worst->standing;
  const std::string other = judged.kinds[worst->simpler].kind.title;
  const std::string facts = "(" + detail::change_text(*worst) + detail::seeds_text(*worst) + ")";
  const double r2 = detail::r2_of(judged.kinds[candidate]);
  if (!(r2 > 0)) {
    verdict.standing = Standing::worse_than_mean;
    verdict.sentence =
        in_words("no success: the mean of the held-out commands would be as good or better, R^2 %.2f", r2);
    return verdict;
  }
  switch (verdict.standing) {
    case Standing::success:
      verdict.sentence = "better than each simpler model; the nearest is " + other + " " + facts;
      break;
    case Standing::undecided: {
      const std::size_t pairs = worst->flights.pairs;
      verdict.sentence = "undecided against " + other + ", which is simpler " + facts;
      if (pairs < fewest_pairs) {
        verdict.sentence += ": " + std::to_string(pairs) + (pairs == 1 ? " held-out flight" : " held-out flights") +
                            " can't tell, " + std::to_string(fewest_pairs) + " or more can";
      }
      break;
    }
    case Standing::no_better:
      verdict.sentence = "no success: no better than " + other + ", which is simpler " + facts;
      break;
    default: verdict.sentence = "no success: worse than " + other + ", which is simpler " + facts;
  }
  return verdict;
}

/// Of all kinds, in their order; of those that were not judged it is empty.
inline std::vector<KindVerdict> verdicts_on(const JudgedKinds& judged) {
  std::vector<KindVerdict> verdicts(judged.kinds.size());
  for (std::size_t kind = 0; kind < judged.kinds.size(); ++kind) {
    if (judged.kinds[kind].applicable()) verdicts[kind] = verdict_on_kind(judged, kind);
  }
  return verdicts;
}

/// Applicable kinds by their held-out R^2, the best first: those that fly on measured motion, or those that look ahead.
inline std::vector<std::size_t> ranking(const JudgedKinds& judged, bool centred) {
  std::vector<std::size_t> order;
  for (std::size_t kind = 0; kind < judged.kinds.size(); ++kind) {
    const JudgedKind& judged_kind = judged.kinds[kind];
    if (judged_kind.applicable() && (judged_kind.kind.reach == TimeReach::centred) == centred) order.push_back(kind);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const double of_a = detail::r2_of(judged.kinds[a]), of_b = detail::r2_of(judged.kinds[b]);
    return (std::isfinite(of_a) ? of_a : -1e300) > (std::isfinite(of_b) ? of_b : -1e300);
  });
  return order;
}

}  // namespace programs
