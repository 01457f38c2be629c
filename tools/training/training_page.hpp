// SPDX-License-Identifier: MIT
// The report page of a training: all that it says as one JSON value, for the template training_page.html.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "command_line/flight_verdict.hpp"
#include "flight/loop_figures.hpp"
#include "training/training_report.hpp"

namespace programs {

/// Contents of a page.
struct TrainingPage {
  const FitPlan& plan;
  const pinnquad::logs::ImportedDataset& dataset;
  const Fits& fits;
  const JudgedKinds& judged;
  const std::vector<KindVerdict>& verdicts;
  const nlohmann::json& report;                ///< report.json
  std::optional<std::size_t> exported;         ///< of judged.kinds: what was exported, or would have been
  std::string export_sentence;                 ///< what became of it
  std::map<std::string, std::string> watched;  ///< flight -> file to watch it in 3D, where there is one
  const HeldOutDynamics* dynamics = nullptr;   ///< of the kind that is shown first
  const FlightVerdict* found = nullptr;        ///< on what was exported; null: nothing was judged for it
  const FlownTraces* traces = nullptr;         ///< of its closed loop
  std::string inputs{};                        ///< C++ that fills its Inputs; empty: nothing was exported
};

/// The predictions of a kind's first seed, parting by parting.
std::vector<const Predictions*> shown_predictions(const TrainingPage& in, std::size_t kind);

/// The whole page.
std::string training_page(const TrainingPage& in);

}  // namespace programs
