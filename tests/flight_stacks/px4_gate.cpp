// SPDX-License-Identifier: MIT
//
// The core of px4_module behind C functions, for the compile gates: its glue needs PX4's tree.
#include <new>

#if __has_include("model.hpp")
#include "model.hpp"
#else
#include "models/demo_quadrotor.hpp"
using TrainedQuadModel = DemoQuadModel;
#endif
#include "pinnquad/control/autopilot/recorded_controller.hpp"
#include "px4_module/neural_control_core.hpp"

namespace {
using Core = pinnquad_px4::NeuralControl<TrainedQuadModel>;
using RecordedCore =
    pinnquad_px4::NeuralControl<TrainedQuadModel,
                                pinnquad::autopilot::Recorded<pinnquad::autopilot::NeuralController<TrainedQuadModel>>>;
using LearningController =
    pinnquad::autopilot::NeuralController<TrainedQuadModel, pinnquad::ModelView<TrainedQuadModel>,
                                          pinnquad::Quadrotor<float, pinnquad::QuadraticDrag>, void,
                                          pinnquad::OnboardInverse<float>>;
using LearningCore = pinnquad_px4::NeuralControl<TrainedQuadModel, pinnquad::autopilot::Recorded<LearningController>>;
}  // namespace

extern "C" {

unsigned long pinnquad_flight_px4_bytes() { return sizeof(Core); }

/// `memory`: pinnquad_flight_px4_bytes() of them, aligned for 64-bit integers.
Core* pinnquad_flight_px4_make(void* memory, Core::ClockUs clock) { return new (memory) Core(clock); }

unsigned char pinnquad_flight_px4_offer_model(Core* core, const void* block, unsigned long length) {
  return static_cast<unsigned char>(core->offer_model(block, length));
}

bool pinnquad_flight_px4_run(Core* core, const pinnquad_px4::VehicleAngularVelocity* rates,
                             const pinnquad_px4::VehicleAttitude* attitude,
                             const pinnquad_px4::VehicleLocalPosition* local,
                             const pinnquad_px4::TrajectorySetpoint* set_point, pinnquad_px4::ActuatorMotors* motors,
                             pinnquad_px4::PinnquadStatus* status) {
  static_cast<void>(core->take(*rates));
  static_cast<void>(core->take(*attitude));
  static_cast<void>(core->take(*local));
  static_cast<void>(core->take(*set_point));
  return core->run(*motors, *status);
}

/// A module that logs its inputs.
bool pinnquad_flight_px4_run_recorded(RecordedCore* core, const pinnquad_px4::VehicleAngularVelocity* rates,
                                      const pinnquad_px4::VehicleAttitude* attitude,
                                      const pinnquad_px4::VehicleLocalPosition* local,
                                      const pinnquad_px4::TrajectorySetpoint* set_point,
                                      pinnquad_px4::ActuatorMotors* motors, pinnquad_px4::PinnquadStatus* status,
                                      pinnquad::autopilot::CoreRecord* record) {
  static_cast<void>(core->take(*rates));
  static_cast<void>(core->take(*attitude));
  static_cast<void>(core->take(*local));
  static_cast<void>(core->take(*set_point));
  const bool has_commands = core->run(*motors, *status);
  *record = core->controller().record();
  return has_commands;
}

/// A module that learns its vehicle.
bool pinnquad_flight_px4_run_learning(LearningCore* core, const pinnquad::autopilot::Situation* situation,
                                      pinnquad_px4::ActuatorMotors* motors, pinnquad_px4::PinnquadStatus* status) {
  core->situation(*situation);
  return core->run(*motors, *status);
}

}  // extern "C"
