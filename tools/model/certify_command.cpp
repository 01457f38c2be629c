// SPDX-License-Identifier: MIT
// Says of a model whether each signed sum of its commands rises with the angular
// acceleration about its axis: proven by its structure (docs/certificate.md), or refuted by two motions inside its
// envelope.
//   pinnquad certify my_model/model.hpp
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "command_line/command.hpp"
#include "command_line/console.hpp"
#include "command_line/options.hpp"
#include "model/findings.hpp"
#include "model/given_model.hpp"
#include "model/model_evidence.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "training/certificate_words.hpp"

namespace {

using namespace pinnquad;
using programs::bias_time_constants_s, programs::Findings, programs::has_base, programs::in_words,
    programs::least_thrust_slope, programs::print_entry;

constexpr int exit_neither = 3;

struct CertifyOptions {
  std::string model;
  double seconds = 5;
  std::uint64_t seed = 1;
  bool json = false;
};

void print_bias(const BlockModel& model) {
  const auto times_s = bias_time_constants_s(model);
  if (!times_s) return;
  print_entry("bias", programs::bias_in_words(model.airframe()) +
                          "; time constants: " + programs::time_constants_in_words(*times_s));
}

void print_thrust(const BlockModel& model, const Findings& findings) {
  if (!findings.thrust) return;
  const Certificate& certificate = *findings.certificate();
  const double own = hover_thrust_slope(model.airframe()), floor = least_thrust_share * own;
  const double held = certificate.held_thrust_slope;
  std::string line = in_words(
      "the sum of the commands by the thrust asked: %.6f s^2/m, %.2f of the airframe's own in hover", held, held / own);
  if (findings.past_or_future)
    line += in_words(", of one that is held; of the present alone %.6f", certificate.thrust_slope);
  print_entry("thrust", line + (has_base(model) ? ", while the base's commands are in 0 to 1" : ""));
  const double range = certificate.residual_upper[0] - certificate.residual_lower[0];
  const double least = least_thrust_slope(findings);
  if (range > 0 && std::isfinite(least))
    print_entry("", in_words("with the residual %.6f or more at every input", least));
  if (range > 0 && held > floor && least < floor) {
    print_entry("",
                in_words("the residual may take %.6f: half of the airframe's is sure over a step of %.3g m/s^2 or more",
                         range, range / (held - floor)));
  }
}

void print_with_rates(const Findings& findings) {
  if (!findings.with_rates[0]) {
    print_entry("with rates", "nothing is known of an acceleration that is held with the body rates that it makes");
    return;
  }
  bool above = true;
  print_entry("with rates",
              "of an acceleration held from the window's first instant on, with the body rates that it makes");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double least = findings.with_rates[axis]->least(axis + 1);
    print_entry("", in_words("%-5s ", programs::axis_names[axis]) +
                        (std::isfinite(least) ? in_words("%.6f s^2/rad or more", least) : "nothing is known"));
    above = above && least > 0;
  }
  if (!above) {
    print_entry("warning",
                "an acceleration that is held is proven with the body rates as they are; with those that it makes the "
                "sum may fall");
  }
}

void print_rounding(const Findings& findings) {
  print_entry("rounding", "turns no order of two accelerations of the present: a sum may rest, it never falls");
  const Certificate& certificate = *findings.certificate();
  if (!std::isfinite(certificate.rounding)) return;
  const double* step = certificate.sure_step;
  print_entry("", in_words("inside the envelope the base's commands are within %.1e of the real ones, and a sum rises "
                           "for sure from a step of %.1e, %.1e, %.1e rad/s^2 on%s",
                           certificate.rounding, step[0], step[1], step[2],
                           findings.past_or_future ? "; over a smaller one that is held it may fall" : ""));
}

/// Of a model that is not proven.
void print_provable(const Findings& findings) {
  std::string uncounted;
  for (const std::string& name : findings.uncounted) uncounted += (uncounted.empty() ? "" : ", ") + printable(name);
  if (!uncounted.empty()) {
    print_entry("no proof",
                "the affine part counts the angular acceleration of a tap as three features; these show one beside "
                "them, or may show one: " +
                    uncounted);
  }
  print_entry("provable",
              "an affine network, and what pinnquad train fits to the same flights (docs/structured_models.md)");
}

void print_proof(const BlockModel& model, const Findings& findings) {
  const AxisSlopes own = hover_slopes(model.airframe());
  print_entry("proven",
              std::string("each signed sum of the commands rises with the angular acceleration about its "
                          "axis") +
                  (findings.certificate() == nullptr ? "" : " and with no other, before a limit clips a command") +
                  ", " + programs::least_share_in_words(findings.proof->held_slope, own));
  print_entry("for", "all finite features, inside the envelope and outside of it");
  print_entry("by", in_words(*findings.proof));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::string line = in_words("%-5s %.6f s^2/rad, %.2f of the airframe's own in hover", programs::axis_names[axis],
                                findings.proof->held_slope[axis], findings.proof->held_slope[axis] / own[axis]);
    if (findings.past_or_future) {
      line += in_words(", of one that is held; of the present alone %.6f", findings.proof->slope[axis]);
    }
    print_entry(axis == 0 ? "slope" : "", line);
  }
  const std::string doubt = programs::slopes_doubt(programs::odd_slopes(*findings.proof, model.airframe()));
  if (!doubt.empty()) print_entry("warning", doubt);
  if (findings.certificate() == nullptr) return;
  print_entry("bound", programs::bound_in_words(*findings.certificate()));
  print_bias(model);
  print_thrust(model, findings);
  if (findings.past_or_future) print_with_rates(findings);
  print_rounding(findings);
}

programs::FlightVerdict verdict_of(const BlockModel& model, const Findings& findings) {
  return programs::model_verdict(programs::evidence_of(model, findings));
}

void print_text(const BlockModel& model, const Findings& findings) {
  const programs::Counterexample* found = findings.search.found ? &*findings.search.found : nullptr;
  programs::print_verdict(verdict_of(model, findings));
  print_entry("model", printable(model.path()) + ", for " + model.airframe_name());
  if (findings.proven()) return print_proof(model, findings);
  if (found == nullptr) {
    print_entry("neither", in_words("nothing is proven of this structure, and no counterexample was found in %ld "
                                    "motions (%.1f s)",
                                    findings.search.evaluations, findings.search.seconds));
    for (std::size_t way = 0; way < findings.ways.size(); ++way) {
      print_entry(way == 0 ? "least" : "",
                  in_words("%-5s %.6f s^2/rad%s", programs::axis_names[findings.ways[way].axis],
                           findings.search.least[way], findings.ways[way].held ? ", held" : ""));
    }
    print_provable(findings);
    return;
  }
  print_entry("refuted",
              in_words("more %s acceleration is asked, and less is commanded: found after %ld motions, %.3f s",
                       programs::axis_names[found->asked.axis], findings.search.evaluations, findings.search.seconds));
  print_entry("at", "(inside the training envelope)");
  for (std::size_t i = 0; i < found->x.size(); ++i) {
    print_entry("", in_words("%-12s %.9g", findings.names[i].c_str(), found->x[i]));
  }
  print_entry("more",
              in_words("%s%s larger by %.6g: the signed sum falls from %.6f to %.6f (derivative %.6f s^2/rad)",
                       findings.names[found->asked.places.front()].c_str(), found->asked.held ? " at all instants" : "",
                       found->step, found->sum, found->sum_of_more, found->derivative));
  print_provable(findings);
}

int certify(const CertifyOptions& options) {
  const BlockModel model = programs::read_model(options.model);
  const Findings findings = programs::findings_of(model, options.seconds, options.seed);
  if (options.json) {
    nlohmann::json report = programs::findings_json(model, findings);
    report["flight_verdict"] = programs::verdict_json(verdict_of(model, findings));
    std::printf("%s\n", report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else {
    print_text(model, findings);
  }
  if (findings.proven()) return 0;
  return findings.search.found ? programs::exit_failed : exit_neither;
}

}  // namespace

namespace programs {

Command certify_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "certify",
      "Proves that more demanded angular acceleration always commands more torque, or finds a counterexample");
  const auto options = std::make_shared<CertifyOptions>();
  add_model(*line, options->model);
  add_number(*line, "--seconds", options->seconds, 0.01, 3600.0,
             "CPU time of the search for a counterexample, s, if nothing is proven");
  add_number(*line, "--seed", options->seed, std::uint64_t{0}, most_seed, "of the search")->type_name("N");
  line->add_flag("--json", options->json, "what was found as JSON");
  line->footer(
      "Examples:\n"
      "  pinnquad train d1.csv --out my_model\n"
      "  pinnquad certify my_model/model.hpp\n"
      "Exit codes: 0 proven; 1 refuted by a counterexample; 2 bad input or a file that can't be read; 3 neither; 130\n"
      "interrupted.");
  return {line, [options] { return certify(*options); }};
}

}  // namespace programs
