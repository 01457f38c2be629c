// SPDX-License-Identifier: MIT
// Models of blocks judged: on flights, by a proof, in the closed loop; and the verdict on them, that of the program.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "flight/waypoints.hpp"
#include "loop/model_flight.hpp"
#include "python/interruptible.hpp"
#include "python/json.hpp"

namespace python {

namespace {

using pinnquad::BlockModel;

nlohmann::json verdict_on(const programs::ModelEvidence& evidence) {
  return verdict_json(programs::model_verdict(evidence));
}

py::object evaluate(const BlockModel& model, const py::object& flights, const std::string& rows) {
  if (rows != "all" && rows != "test") refuse_name("rows", rows, std::array<const char*, 2>{"all", "test"});
  const std::shared_ptr<const pinnquad::Dataset> dataset = dataset_of(flights);
  nlohmann::json report;
  {
    const py::gil_scoped_release without_gil;
    SignalWatch watch;
    const programs::EvaluatedModel evaluation =
        programs::evaluated(model, programs::rows_to_judge(*dataset, rows), [&watch](double) { watch.look(); });
    report = programs::evaluation_json(model, *dataset, rows, evaluation);
    report["verdict"] = verdict_on(programs::evidence_of(model, evaluation));
  }
  return to_python(report);
}

py::object certify(const BlockModel& model, double seconds, std::uint64_t seed) {
  checked("seconds", seconds, 0.01);
  nlohmann::json report;
  run_interruptible([&] {
    const programs::Findings findings = programs::findings_of(model, seconds, seed);
    report = programs::findings_json(model, findings);
    report["flight_verdict"] = verdict_on(programs::evidence_of(model, findings));
  });
  return to_python(report);
}

py::object verdict_of(const BlockModel& model) {
  nlohmann::json verdict;
  {
    const py::gil_scoped_release without_gil;
    verdict = verdict_on(programs::evidence_of(model));
  }
  return to_python(verdict);
}

/// With where it flew, every tenth of a second.
nlohmann::json trace_json(const programs::FlownTrace& trace) {
  return {{"time_s", trace.time_s},
          {"north_m", trace.north_m},
          {"east_m", trace.east_m},
          {"planned_north_m", trace.planned_north_m},
          {"planned_east_m", trace.planned_east_m},
          {"error_m", trace.error_m}};
}

py::object loop(const BlockModel& model, const std::string& trajectory, const py::object& airframe,
                const std::vector<std::string>& columns, const std::string& battery, double charge_percent,
                bool guarded) {
  const auto& ready = programs::loop_trajectories;
  if (!programs::is_waypoint_file(trajectory) && std::find(ready.begin(), ready.end(), trajectory) == ready.end()) {
    refuse_name("trajectory", trajectory, ready);
  }
  checked("battery_charge", charge_percent, 5);
  std::optional<NamedAirframe> chosen;
  if (!airframe.is_none()) chosen = airframe_of(airframe);
  const programs::LoopVehicle vehicle = programs::loop_vehicle(model, columns, {battery, charge_percent}, chosen);
  nlohmann::json report, traces;
  {
    const py::gil_scoped_release without_gil;
    programs::ModelFlight flown = programs::fly_model(model, vehicle, trajectory, guarded ? "envelope" : "none");
    report = std::move(flown.report);
    traces = {{"model", trace_json(flown.flights.traces.model)},
              {"without_jerk", trace_json(flown.flights.traces.without)}};
  }
  return py::make_tuple(to_python(report), to_python(traces));
}

}  // namespace

void bind_verdicts(py::module_& module) {
  module.def("_evaluate", &evaluate, py::arg("model"), py::arg("flights"), py::arg("rows"), "Of pinnquad.evaluate().");
  module.def("_certify", &certify, py::arg("model"), py::arg("seconds"), py::arg("seed").noconvert(),
             "Of pinnquad.certify().");
  module.def("_verdict", &verdict_of, py::arg("model"), "Of Model.flight_verdict.");
  module.def("_loop", &loop, "Of pinnquad.loop().");
}

}  // namespace python
