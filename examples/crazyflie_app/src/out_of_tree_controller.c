/* SPDX-License-Identifier: MIT
 * The glue between the Crazyflie's firmware and neural_control_core.h: structures, model, who flies, log variables.
 * Compiled and run here against stand-ins of the firmware's headers (tests/flight_stacks/crazyflie). */
#include <stdbool.h>
#include <stdint.h>

#include "FreeRTOS.h"
#include "app.h"
#include "autoconf.h"
#include "config.h"
#include "controller.h"
#include "controller_pid.h"
#include "core_log.h"
#include "eventtrigger.h"
#include "log.h"
#include "neural_control_core.h"
#include "param.h"
#include "platform_defaults.h"
#include "pm.h"
#include "sample_clock.h"
#include "stabilizer_types.h"
#include "supervisor.h"
#include "task.h"
#include "usec_time.h"

#define DEBUG_MODULE "PINNQUAD"
#include "debug.h"

#ifndef CONFIG_CONTROLLER_OOT
#error "pinnquad: CONFIG_CONTROLLER_OOT must be set (app-config)"
#endif
#if !defined(CONFIG_ESTIMATOR_KALMAN_ENABLE) && !defined(CONFIG_ESTIMATOR_UKF_ENABLE)
#error "pinnquad: needs the Kalman estimator: the complementary one estimates no x and y (app-config)"
#endif
#ifndef CONFIG_ENABLE_THRUST_BAT_COMPENSATED
#error "pinnquad: needs CONFIG_ENABLE_THRUST_BAT_COMPENSATED: else controlModeForce sets voltages (app-config)"
#endif
/* The stack of a step below the stabilizer's own frames, and that of those, of interrupts and of the PID controller.
 * The first is checked against the compiler's own count (tests/flight_stacks/stack_depth.py). */
#define PINNQUAD_STEP_STACK_BYTES 1400
#define STABILIZER_OWN_STACK_BYTES 400
_Static_assert(STABILIZER_TASK_STACKSIZE * sizeof(StackType_t) >=
                   PINNQUAD_STEP_STACK_BYTES + STABILIZER_OWN_STACK_BYTES,
               "pinnquad: the stabilizer's task has too little stack: raise STABILIZER_TASK_STACKSIZE in config.h");

/* model_block.S */
extern const unsigned char pinnquad_model_block[];
extern const unsigned char pinnquad_model_block_end[];

static struct CrazyflieReport report;
static uint8_t model_status = 255; /* pinnquad::Status of the model; 255: not looked at yet */
static volatile bool ready;        /* a model was accepted: before, the stabilizer does not touch the core */
static uint8_t gave_up;            /* until the next set point that is off or by hand */
static uint8_t pid_flies = 1;      /* no model, given up, off or by hand */
static uint8_t stands;             /* on the ground, its motors not above their idling since */
static uint16_t step_us;           /* inference time: outer loop and inverse */
static float force_scale;          /* greatest thrust of the model's rotor over the platform's THRUST_MAX */
#ifdef PINNQUAD_ONBOARD
static uint8_t learning; /* 0 off, 1 learns, 2 excites, 3 frozen */
#endif

/* Not on the stabilizer's stack. */
static struct CrazyflieState at;
static struct CrazyflieSetpoint wanted;
static float forces[STABILIZER_NR_OF_MOTORS];
static struct CrazyflieSampleClock attitude_clock, position_clock;
/* The PID controller's own: its output holds state between its slower steps, and forces lie in the same bytes. */
static control_t pid_control;

/* The core's inputs and answers, and its settings: for the uSD card, where config.txt asks for them. By hand what
 * the firmware's EVENTTRIGGER does for up to five variables. */
static struct CrazyflieCoreRecord record;
static const eventtriggerPayloadDesc record_variables[] = {
    PINNQUAD_RECORD_LIST(PINNQUAD_EVENT_ONE, PINNQUAD_EVENT_MANY, PINNQUAD_EVENT_TIME)};
static const eventtrigger record_event __attribute__((section(".eventtrigger.pinnquad_record"), used)) = {
    .name = "pinnquad_record",
    .payloadDesc = record_variables,
    .numPayloadVariables = sizeof record_variables / sizeof record_variables[0],
    .payload = &record,
    .payloadSize = sizeof record};
static struct CrazyflieCoreSettings settings;
static const eventtriggerPayloadDesc settings_variables[] = {
    PINNQUAD_SETTINGS_LIST(PINNQUAD_EVENT_ONE, PINNQUAD_EVENT_MANY, PINNQUAD_EVENT_TIME)};
static const eventtrigger settings_event __attribute__((section(".eventtrigger.pinnquad_settings"), used)) = {
    .name = "pinnquad_settings",
    .payloadDesc = settings_variables,
    .numPayloadVariables = sizeof settings_variables / sizeof settings_variables[0],
    .payload = &settings,
    .payloadSize = sizeof settings};
_Static_assert(sizeof record <= 255 && sizeof settings <= 255, "pinnquad: an event's payload has at most 255 bytes");
static uint8_t record_every = 1; /* of the steps; 0: none */

static uint32_t now_ms(void) { return T2M(xTaskGetTickCount()); }

/* In the app's task, whose stack is ours to choose: opening and testing a model takes some. */
void appMain(void) {
  force_scale = pinnquad_flight_start(THRUST_MAX);
  model_status =
      pinnquad_flight_offer_model(pinnquad_model_block, (size_t)(pinnquad_model_block_end - pinnquad_model_block));
  ready = model_status == 0;
  if (!ready) DEBUG_PRINT("model refused (%u): PID flies\n", (unsigned)model_status);
  while (1) vTaskDelay(M2T(2000));
}

/* At each change to this controller: until it has answered, another one flies. */
void controllerOutOfTreeInit(void) {
  pid_flies = 1;
  stands = 0;
  controllerPidInit();
}

bool controllerOutOfTreeTest(void) { return controllerPidTest(); }

static void copy(float to[3], float x, float y, float z) {
  to[0] = x;
  to[1] = y;
  to[2] = z;
}

/* The firmware calls it flying until 2 s after any motor turned above the firmware's idle thrust, 0 on most platforms:
 * also while the core idles on the ground. So it stands since the firmware said so, until the core uses more than that,
 * or the PID controller does where it flies. */
static bool stands_still(bool drives_motors, bool pid_is_asked) {
  if (!supervisorIsFlying()) {
    stands = 1;
  } else if (drives_motors ? report.lift > 0.0f : pid_is_asked && pid_control.thrust > 0.0f) {
    stands = 0;
  }
  return stands;
}

/* Off, or flown by hand. */
static bool is_by_hand(const setpoint_t* setpoint) {
  return setpoint->mode.x == modeDisable || setpoint->mode.y == modeDisable || setpoint->mode.z == modeDisable;
}

static void copy_state(const sensorData_t* sensors, const state_t* state) {
  const uint32_t now = now_ms();
  /* the gyro has a time of its own, in us */
  const uint32_t gyro_age_ms = (uint32_t)((usecTimestamp() - sensors->interruptTimestamp) / 1000);
  at.gyro_timestamp = now - gyro_age_ms;
  copy(at.gyro, sensors->gyro.x, sensors->gyro.y, sensors->gyro.z);
  at.attitude_quaternion[0] = state->attitudeQuaternion.x;
  at.attitude_quaternion[1] = state->attitudeQuaternion.y;
  at.attitude_quaternion[2] = state->attitudeQuaternion.z;
  at.attitude_quaternion[3] = state->attitudeQuaternion.w;
  at.attitude_timestamp =
      crazyflie_sample_time(&attitude_clock, state->attitude.timestamp, now, at.attitude_quaternion, 4);
  copy(at.position, state->position.x, state->position.y, state->position.z);
  copy(at.velocity, state->velocity.x, state->velocity.y, state->velocity.z);
  const float local[6] = {at.position[0], at.position[1], at.position[2],
                          at.velocity[0], at.velocity[1], at.velocity[2]};
  at.position_timestamp = crazyflie_sample_time(&position_clock, state->position.timestamp, now, local, 6);
  at.battery_voltage = pmGetBatteryVoltage();
  at.drives_motors = !pid_flies && supervisorAreMotorsAllowedToRun();
#ifdef PINNQUAD_ONBOARD
  at.learning = learning;
#endif
}

static void copy_setpoint(const setpoint_t* setpoint) {
  wanted.timestamp = setpoint->timestamp;
  copy(wanted.position, setpoint->position.x, setpoint->position.y, setpoint->position.z);
  copy(wanted.velocity, setpoint->velocity.x, setpoint->velocity.y, setpoint->velocity.z);
  copy(wanted.acceleration, setpoint->acceleration.x, setpoint->acceleration.y, setpoint->acceleration.z);
  wanted.yaw = setpoint->attitude.yaw;
  wanted.yaw_rate = setpoint->attitudeRate.yaw;
  wanted.velocity_body = setpoint->velocity_body;
  wanted.mode[0] = (uint8_t)setpoint->mode.x;
  wanted.mode[1] = (uint8_t)setpoint->mode.y;
  wanted.mode[2] = (uint8_t)setpoint->mode.z;
  wanted.mode_yaw = (uint8_t)setpoint->mode.yaw;
  wanted.attitude_quaternion[0] = setpoint->attitudeQuaternion.x;
  wanted.attitude_quaternion[1] = setpoint->attitudeQuaternion.y;
  wanted.attitude_quaternion[2] = setpoint->attitudeQuaternion.z;
  wanted.attitude_quaternion[3] = setpoint->attitudeQuaternion.w;
  wanted.mode_quat = (uint8_t)setpoint->mode.quat;
}

/* After a step. A card that is too slow loses whole events: ticks that were not logged, which replay knows. */
static void write_record(void) {
  static uint8_t since_record;
  static uint16_t since_settings = UINT16_MAX;
  if (record_every == 0) return;
  if (++since_record >= record_every) {
    since_record = 0;
    pinnquad_flight_record(&record);
    eventTrigger(&record_event);
  }
  if (++since_settings >= 500 || since_settings == 0) { /* each second: logging may start at any time */
    since_settings = 1;
    pinnquad_flight_settings(now_ms(), &settings);
    eventTrigger(&settings_event);
  }
}

void controllerOutOfTree(control_t* control, const setpoint_t* setpoint, const sensorData_t* sensors,
                         const state_t* state, const stabilizerStep_t stabilizerStep) {
  /* The PID controller is stepped while the network flies: its filters follow, and taking over is warm. */
  controllerPid(&pid_control, setpoint, sensors, state, stabilizerStep);
  if (ready && RATE_DO_EXECUTE(RATE_500_HZ, stabilizerStep)) {
    const bool by_hand = is_by_hand(setpoint);
    copy_state(sensors, state);
    at.landed = stands_still(at.drives_motors, by_hand || gave_up);
    copy_setpoint(setpoint);
    const uint64_t start_us = usecTimestamp();
    const bool has_forces = pinnquad_flight_step(now_ms(), &at, &wanted, forces, &report);
    step_us = (uint16_t)(usecTimestamp() - start_us);
    write_record();
    /* Off, or flown by hand: the PID controller's, and the module may fly again afterwards. Given up: the PID
     * controller's until then. */
    if (by_hand) gave_up = 0;
    if (!by_hand && !has_forces) gave_up = 1;
    pid_flies = by_hand || gave_up;
  }
  if (pid_flies) {
    *control = pid_control;
    return;
  }
  /* Not more than 1 of any: the platform would clip each motor for itself, and torque with it. */
  control->controlMode = controlModeForce;
  for (int motor = 0; motor < STABILIZER_NR_OF_MOTORS; motor++) {
    control->normalizedForces[motor] = forces[motor] * force_scale;
  }
}

PARAM_GROUP_START(pinnquad)
PARAM_ADD(PARAM_FLOAT, forceScale, &force_scale)
PARAM_ADD(PARAM_UINT8, recordEvery, &record_every)
#ifdef PINNQUAD_ONBOARD
PARAM_ADD(PARAM_UINT8, learning, &learning)
#endif
PARAM_GROUP_STOP(pinnquad)

LOG_GROUP_START(pinnquad)
LOG_ADD(LOG_UINT8, model, &model_status)
LOG_ADD(LOG_UINT8, gaveUp, &gave_up)
LOG_ADD(LOG_UINT8, pidFlies, &pid_flies)
LOG_ADD(LOG_UINT16, stepUs, &step_us)
LOG_ADD(LOG_UINT8, reaction, &report.reaction)
LOG_ADD(LOG_UINT8, status, &report.status)
LOG_ADD(LOG_UINT8, cause, &report.cause)
LOG_ADD(LOG_UINT8, stale, &report.stale_inputs)
LOG_ADD(LOG_UINT8, bias, &report.bias_status)
LOG_ADD(LOG_FLOAT, fallback, &report.fallback_share)
LOG_ADD(LOG_FLOAT, excess, &report.envelope_excess)
LOG_ADD(LOG_INT8, feature, &report.envelope_feature)
LOG_ADD(LOG_UINT32, refused, &report.refused_samples)
LOG_GROUP_STOP(pinnquad)
