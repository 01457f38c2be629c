// SPDX-License-Identifier: MIT
// Simulated flights, held out, fitted and judged as `train` does it, with kinds of models of one's choice.
#pragma once

#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "airframe/choice.hpp"
#include "simulated_dataset.hpp"
#include "stand_in_kinds.hpp"
#include "training/kind_verdict.hpp"

namespace pinnquad_test {

struct Judged {
  programs::NamedAirframe airframe = programs::chosen_airframe(pinnquad::PaperQuadrotor::name);
  pinnquad::Dataset dataset;
  programs::FitPlan plan;
  programs::Fits fits;
  programs::JudgedKinds judged;
  std::vector<programs::KindVerdict> verdicts;

  Judged(int flights, std::vector<programs::ModelKind> kinds, const programs::HoldOutChoice& choice, int seeds = 5)
      : Judged(simulated_dataset(flights, 400), std::move(kinds), choice, seeds) {}
  Judged(pinnquad::Dataset flights, std::vector<programs::ModelKind> kinds, const programs::HoldOutChoice& choice,
         int seeds = 5)
      : dataset(std::move(flights)),
        plan{airframe, std::move(kinds), programs::folds_of(dataset, choice), {}, 0.05, 1, seeds, 0, 1} {
    fits = programs::fit_all(plan);
    judged = programs::judge_fits(plan, fits);
    verdicts = programs::verdicts_on(judged);
  }
  const programs::KindVerdict& of(const std::string& key) const {
    for (std::size_t k = 0; k < judged.kinds.size(); ++k) {
      if (judged.kinds[k].kind.key == key) return verdicts[k];
    }
    FAIL("no kind " << key);
    return verdicts.front();
  }
};

inline const programs::HoldOutChoice each_flight{{}, programs::HoldOutEach::flight};

}  // namespace pinnquad_test
