// SPDX-License-Identifier: MIT
// Says of a model, a block or an exported header, whether each signed sum of its commands rises with the angular
// acceleration about its axis: proven by its structure (docs/certificate.md), or refuted by two motions inside its
// envelope.
//   pinnquad certify my_model/model.hpp
#include "model/certify_command.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "command_line/console.hpp"
#include "command_line/interrupt.hpp"
#include "model/asked_model.hpp"
#include "model/counterexample.hpp"
#include "model/model_file.hpp"
#include "model/model_options.hpp"
#include "pinnquad/inference/certificate.hpp"
#include "pinnquad/inference/hover_slopes.hpp"
#include "training/certificate_words.hpp"

namespace {

using namespace pinnquad;

constexpr int exit_neither = 3;
constexpr std::array<const char*, 3> axes = {Roll::name, Pitch::name, Yaw::name};

struct CertifyOptions {
  std::string model;
  programs::ModelHints hints;
  double seconds = 5;
  std::uint64_t seed = 1;
  bool json = false;
};

/// What is known of a model in the end.
struct Findings {
  const char* argument = "";  ///< of a proof; empty: none
  std::array<double, 3> slope{}, held_slope{};
  std::optional<Certificate> certificate;  ///< of a structure
  double rounding = 0;                     ///< see base_rounding()
  programs::Search search;                 ///< where nothing is proven
  std::vector<programs::AskedMore> ways;   ///< of the search
  std::vector<std::string> names;          ///< of the features
  std::size_t taps = 1;                    ///< with an angular acceleration

  bool proven() const { return *argument != '\0'; }
};

constexpr const char* by_structure =
    "structure: an affine base in which each signed sum sees the angular acceleration about its own axis alone, with a "
    "slope above 0, and a residual that sees none";
constexpr const char* by_path_bound =
    "structure and path bound: an affine base in which each signed sum sees the angular acceleration about its own "
    "axis alone, and a network whose weights leave the slopes above 0 on every path from it";
constexpr const char* by_affinity = "the model is affine: its derivatives are the same everywhere";

/// Of a network that is shown the angular acceleration: by tap and axis.
template <class Scalar>
std::vector<PathBound<4>> path_bounds(const programs::NetworkSpec& network, const Scalar* parameters,
                                      const std::vector<int>& taps) {
  std::vector<int> widths;
  for (const programs::LayerSpec& layer : network.layers) {
    if (layer.size > 0) widths.push_back(layer.size);
  }
  const int widest = *std::max_element(widths.begin(), widths.end());
  std::vector<double> work(4 * static_cast<std::size_t>(widest));
  std::vector<PathBound<4>> all;
  for (const int place : taps) {
    for (int axis = 0; axis < 3; ++axis) {
      PathBound<4>& bound = all.emplace_back();
      path_bound(parameters, network.inputs, widths.data(), static_cast<int>(widths.size()), place + axis, work.data(),
                 widest, static_cast<double*>(bound.lower), static_cast<double*>(bound.upper));
    }
  }
  return all;
}

/// The certificate of a model that has the structure.
template <class Scalar>
std::optional<Certificate> structure_certificate(const programs::Block& block, const programs::Identity& identity,
                                                 const std::vector<int>& taps) {
  const std::vector<programs::NetworkSpec>& parts = identity.networks;
  const programs::NetworkSpec& base = parts.front();
  if (!base.axis_aligned || base.threes != taps || parts.size() > 2) return {};
  const auto in_scalar = [](const std::vector<double>& values) {
    std::vector<Scalar> result;
    for (const double value : values) result.push_back(static_cast<Scalar>(value));
    return result;
  };
  const std::vector<Scalar> parameters = in_scalar(block.parameters), input = in_scalar(block.input_spread),
                            output = in_scalar(block.output_spread);
  const Scalar* bounds = nullptr;
  std::vector<PathBound<4>> paths;
  if (parts.size() == 2) {
    const bool withheld = parts[1].threes == taps;
    if (!parts[1].bounded || parts[1].axis_aligned || !(withheld || parts[1].path_bounded)) return {};
    bounds = parameters.data() + base.parameter_count();
    if (parts[1].path_bounded) paths = path_bounds(parts[1], bounds + 8, taps);
  }
  return certificate_of(CertifiedNumbers<Scalar>{
      static_cast<int>(taps.size()), taps.data(), parameters.data(), bounds, input.data(), output.data(),
      SignedSumOutputs::prepare(airframe_in<Scalar>(identity.airframe.value)), paths.empty() ? nullptr : paths.data()});
}

bool sees_angular_acceleration(const programs::Identity& identity) { return identity.networks.back().path_bounded; }

/// Most that the base's commands, worked out in the model's own scalar, differ from the real ones inside the envelope.
double base_rounding(const programs::Block& block, const programs::Identity& identity, const Certificate& certificate) {
  const programs::NetworkSpec& base = identity.networks.front();
  const auto inputs = static_cast<std::size_t>(block.inputs);
  const std::vector<double> plain = programs::detail::plain_parameters(
      base, block.parameters.data(), block.parameters.data() + base.parameter_count());
  const double unit = block.is_double ? std::ldexp(1.0, -53) : std::ldexp(1.0, -24);
  const double roundings = (static_cast<double>(inputs) + 12) * unit;
  const auto mix = SignedSumOutputs::prepare(identity.airframe.value);
  std::array<double, rotor_count> errors{};
  for (std::size_t k = 0; k < 4; ++k) {
    double magnitude = std::abs(plain[4 * inputs + k]);
    for (std::size_t i = 0; i < inputs; ++i) {
      const double mean = block.input_mean[i];
      const double far = std::max(std::abs(block.envelope_lower[i] - mean), std::abs(block.envelope_upper[i] - mean));
      magnitude += std::abs(plain[k * inputs + i]) * far / block.input_spread[i];
    }
    const double residual = std::max(-certificate.residual_lower[k], certificate.residual_upper[k]);
    const double sum = magnitude * block.output_spread[k] + std::abs(block.output_mean[k]) + residual;
    for (std::size_t rotor = 0; rotor < errors.size(); ++rotor) {
      errors[rotor] += std::abs(mix.by[rotor][k]) * sum * roundings / (1 - roundings);
    }
  }
  return *std::max_element(errors.begin(), errors.end());
}

bool is_affine(const programs::Identity& identity) {
  for (const programs::NetworkSpec& network : identity.networks) {
    if (network.bounded || network.path_bounded) return false;
    for (const programs::LayerSpec& layer : network.layers) {
      if (layer.size == 0) return false;
    }
  }
  return true;
}

/// What is searched where nothing is proven.
programs::SearchedModel searched_model(const programs::Block& block, const programs::Identity& identity,
                                       const programs::AskedModel& model) {
  programs::SearchedModel searched;
  searched.lower = block.envelope_lower;
  searched.upper = block.envelope_upper;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    programs::AskedMore held{axis, true, {}};
    for (const int place : model.taps) held.places.push_back(static_cast<std::size_t>(place) + axis);
    searched.ways.push_back({axis, false, {held.places.front()}});
    if (model.taps.size() > 1) searched.ways.push_back(std::move(held));
  }
  searched.derivatives = [&model, ways = searched.ways](const std::vector<double>& x) {
    const programs::AxisDerivatives now = model.derivatives(x, false);
    const programs::AxisDerivatives held = model.taps.size() > 1 ? model.derivatives(x, true) : now;
    std::vector<double> all;
    for (const programs::AskedMore& way : ways) all.push_back(way.held ? held[way.axis] : now[way.axis]);
    return all;
  };
  const programs::RunTimeAirframe airframe(identity.airframe.name, identity.airframe.value);
  const std::array<std::array<double, rotor_count>, 3> signs = {airframe.signs<Roll>(), airframe.signs<Pitch>(),
                                                                airframe.signs<Yaw>()};
  searched.sums = [&model, signs](const std::vector<double>& x) {
    const Commands<double> commands = model.commands(x);
    return std::array<double, 3>{signed_sum(signs[0], commands), signed_sum(signs[1], commands),
                                 signed_sum(signs[2], commands)};
  };
  const std::size_t size = block.envelope_lower.size();
  for (std::size_t vector = 0; vector < block.golden_count; ++vector) {
    const auto first = block.golden_features.begin() + static_cast<std::ptrdiff_t>(vector * size);
    searched.starts.emplace_back(first, first + static_cast<std::ptrdiff_t>(size));
  }
  return searched;
}

Findings findings_of(const CertifyOptions& options, const programs::Block& block, const programs::Identity& identity) {
  const auto model = programs::asked_model(block, identity);
  Findings findings;
  findings.names = model->names;
  findings.taps = model->taps.size();
  if (model->taps.empty()) {
    throw InputError(block.path, 0, 0, "a model that is asked for an angular acceleration", "one that is not");
  }
  if (model->signed_sums) {
    findings.certificate = programs::certificate_of_block(block, identity, *model);
    if (findings.certificate && findings.certificate->proven()) {
      findings.argument = sees_angular_acceleration(identity) ? by_path_bound : by_structure;
      if (block.base.empty()) findings.rounding = base_rounding(block, identity, *findings.certificate);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        findings.slope[axis] = findings.certificate->slope[axis];
        findings.held_slope[axis] = findings.certificate->held_slope[axis];
      }
      return findings;
    }
  }
  const programs::SearchedModel searched = searched_model(block, identity, *model);
  if (model->affine_schema && is_affine(identity)) {
    const std::vector<double>& anywhere = searched.starts.front();
    findings.slope = model->derivatives(anywhere, false);
    findings.held_slope = model->derivatives(anywhere, true);
    const auto least = [](const std::array<double, 3>& of) { return *std::min_element(of.begin(), of.end()); };
    if (std::min(least(findings.slope), least(findings.held_slope)) > 1e-9) {
      findings.argument = by_affinity;
      return findings;
    }
  }
  findings.search = programs::search_counterexample(searched, options.seed, options.seconds);
  findings.ways = searched.ways;
  return findings;
}

const char* verdict_of(const Findings& findings) {
  return findings.proven() ? "proven" : (findings.search.found ? "counterexample" : "neither");
}

nlohmann::json by_axis(const std::array<double, 3>& values) {
  nlohmann::json all = nlohmann::json::object();
  for (std::size_t axis = 0; axis < 3; ++axis) all[axes[axis]] = values[axis];
  return all;
}

void print_json(const programs::Block& block, const programs::Identity& identity, const Findings& findings) {
  nlohmann::json report = {{"model", block.path},
                           {"answer", identity.answer},
                           {"airframe", identity.airframe.name},
                           {"verdict", verdict_of(findings)}};
  if (findings.proven()) {
    report["argument"] = findings.argument;
    report["inputs"] = "all finite features";
    report["slope"] = by_axis(findings.slope);
    report["held_slope"] = by_axis(findings.held_slope);
    report["airframe_slope"] = by_axis(hover_slopes(identity.airframe.value));
  }
  if (findings.proven() && findings.certificate) {
    report["residual_lower"] = findings.certificate->residual_lower;
    report["residual_upper"] = findings.certificate->residual_upper;
    report["command_bound"] = findings.certificate->command_bound;
    if (block.base.empty()) report["rounding"] = findings.rounding;
    if (sees_angular_acceleration(identity)) {
      const double* other = findings.certificate->other_sums;
      report["other_sums"] = by_axis({other[0], other[1], other[2]});
    }
  }
  if (!findings.proven()) {
    report["evaluations"] = findings.search.evaluations;
    report["seconds"] = findings.search.seconds;
    for (std::size_t way = 0; way < findings.ways.size(); ++way) {
      const programs::AskedMore& asked = findings.ways[way];
      report[asked.held ? "least_held_derivative" : "least_derivative"][axes[asked.axis]] = findings.search.least[way];
    }
  }
  if (!findings.proven() && findings.search.found) {
    const programs::Counterexample& found = *findings.search.found;
    nlohmann::json features = nlohmann::json::object();
    for (std::size_t i = 0; i < found.x.size(); ++i) features[findings.names[i]] = found.x[i];
    nlohmann::json moved = nlohmann::json::array();
    for (const std::size_t place : found.asked.places) moved.push_back(findings.names[place]);
    report["counterexample"] = {{"axis", axes[found.asked.axis]},
                                {"features", features},
                                {"moved", moved},
                                {"step", found.step},
                                {"derivative", found.derivative},
                                {"signed_sum", found.sum},
                                {"signed_sum_after_step", found.sum_of_more}};
  }
  std::printf("%s\n", report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

void print_text(const programs::Block& block, const programs::Identity& identity, const Findings& findings) {
  std::printf("model      %s: %s, for %s\n", printable(block.path).c_str(), identity.answer.c_str(),
              identity.airframe.name.c_str());
  if (findings.proven()) {
    const AxisSlopes own = hover_slopes(identity.airframe.value);
    std::printf("proven     each signed sum of the commands rises with the angular acceleration about its axis%s\n",
                !findings.certificate ? ""
                                      : (sees_angular_acceleration(identity) ? ", and each rotor goes the right way"
                                                                             : " and with no other"));
    std::printf("for        all finite features, inside the envelope and outside of it\n");
    std::printf("by         %s\n", findings.argument);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::printf("%s%-5s %.6f s^2/rad, %.2f of the airframe's own in hover", axis == 0 ? "slope      " : "           ",
                  axes[axis], findings.held_slope[axis], findings.held_slope[axis] / own[axis]);
      if (findings.taps > 1) std::printf(", of one that is held; of the present alone %.6f", findings.slope[axis]);
      std::printf("\n");
    }
    for (const std::string& doubt : programs::slope_doubts(findings.held_slope, own)) {
      std::printf("warning    %s\n", doubt.c_str());
    }
    if (findings.certificate) {
      std::printf("bound      %s\n", programs::bound_in_words(*findings.certificate).c_str());
      if (!block.base.empty()) return;
      if (sees_angular_acceleration(identity)) {
        std::printf(
            "rounding   may turn the order of two accelerations that differ by as little as it does; the proof is of "
            "the real function\n");
        return;
      }
      std::printf(
          "rounding   turns no order: a sum may rest over a small step, it never falls; inside the envelope the base's "
          "commands are within %.1e of the real ones\n",
          findings.rounding);
    }
    return;
  }
  if (!findings.search.found) {
    std::printf(
        "neither    nothing is proven of this structure, and no counterexample was found in %ld motions (%.1f s)\n",
        findings.search.evaluations, findings.search.seconds);
    for (std::size_t way = 0; way < findings.ways.size(); ++way) {
      std::printf("%s%-5s %.6f s^2/rad%s\n", way == 0 ? "least      " : "           ", axes[findings.ways[way].axis],
                  findings.search.least[way], findings.ways[way].held ? ", held" : "");
    }
    return;
  }
  const programs::Counterexample& found = *findings.search.found;
  std::printf("refuted    more %s acceleration is asked, and less is commanded: found after %ld motions, %.3f s\n",
              axes[found.asked.axis], findings.search.evaluations, findings.search.seconds);
  std::printf("at         (inside the training envelope)\n");
  for (std::size_t i = 0; i < found.x.size(); ++i) {
    std::printf("           %-12s %.9g\n", findings.names[i].c_str(), found.x[i]);
  }
  std::printf("more       %s%s larger by %.6g: the signed sum falls from %.6f to %.6f (derivative %.6f s^2/rad)\n",
              findings.names[found.asked.places.front()].c_str(), found.asked.held ? " at all instants" : "",
              found.step, found.sum, found.sum_of_more, found.derivative);
}

int certify(const CertifyOptions& options) {
  programs::end_at_interrupt();
  programs::ModelHints hints = options.hints;
  const programs::Block block = programs::read_block(options.model, programs::block_bytes(options.model, hints));
  const programs::Identity identity = programs::identify(block, hints);
  const Findings findings = findings_of(options, block, identity);
  options.json ? print_json(block, identity, findings) : print_text(block, identity, findings);
  if (findings.proven()) return 0;
  return findings.search.found ? programs::exit_failed : exit_neither;
}

}  // namespace

std::optional<Certificate> programs::certificate_of_block(const Block& block, const Identity& identity,
                                                          const AskedModel& model) {
  if (!model.signed_sums || model.taps.empty()) return {};
  return block.is_double ? structure_certificate<double>(block, identity, model.taps)
                         : structure_certificate<float>(block, identity, model.taps);
}

programs::Command programs::certify_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "certify", "Proves that a model's commands follow the angular acceleration that is asked, or refutes it");
  const auto options = std::make_shared<CertifyOptions>();
  add_model(*line, options->model);
  add_model_hints(*line, options->hints);
  add_number(*line, "--seconds", options->seconds, 0.01, 3600.0,
             "how long, in seconds of the processor, to search a counterexample where nothing is proven");
  add_number(*line, "--seed", options->seed, std::uint64_t{0}, most_seed, "of the search")->type_name("N");
  line->add_flag("--json", options->json, "what was found as JSON");
  line->footer(
      "Examples:\n"
      "  pinnquad train --flight d1.csv --out my_model\n"
      "  pinnquad certify my_model/model.hpp\n"
      "Exit codes: 0 proven; 1 refuted by a counterexample; 2 bad input or a file that can't be read; 3 neither; 130\n"
      "interrupted.");
  return {line, [options] { return certify(*options); }};
}
