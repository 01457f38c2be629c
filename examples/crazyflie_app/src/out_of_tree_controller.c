/* SPDX-License-Identifier: MIT
 * The glue between the Crazyflie's firmware and neural_control_core.h: structures, model, log variables.
 * Not built in this repository; see README.md. */
#include <stdbool.h>
#include <stdint.h>

#include "FreeRTOS.h"
#include "app.h"
#include "controller.h"
#include "controller_pid.h"
#include "log.h"
#include "neural_control_core.h"
#include "param.h"
#include "stabilizer_types.h"
#include "task.h"
#include "usec_time.h"

#define DEBUG_MODULE "PINNQUAD"
#include "debug.h"

/* model_block.S */
extern const unsigned char pinnquad_model_block[];
extern const unsigned char pinnquad_model_block_end[];

static struct CrazyflieReport report;
static uint8_t model_status = 255; /* pinnquad::Status of the model; 255: not looked at yet */
static volatile bool ready;        /* a model was accepted: before, the stabilizer does not touch the core */
static uint8_t gave_up;            /* until the next set point that is off or by hand */
static uint8_t pid_flies = 1;      /* no model, given up, off or by hand */
static uint16_t step_us;           /* inference time: outer loop and inverse */
static float force_scale = 1.0f;   /* greatest thrust of the airframe's rotor over the platform's THRUST_MAX */

static uint32_t now_ms(void) { return T2M(xTaskGetTickCount()); }

/* In the app's task, whose stack is ours to choose: opening and testing a model takes some. */
void appMain(void) {
  model_status =
      pinnquad_flight_offer_model(pinnquad_model_block, (size_t)(pinnquad_model_block_end - pinnquad_model_block));
  ready = model_status == 0;
  if (!ready) DEBUG_PRINT("model refused (%u): PID flies\n", (unsigned)model_status);
  while (1) vTaskDelay(M2T(2000));
}

void controllerOutOfTreeInit(void) { controllerPidInit(); }

bool controllerOutOfTreeTest(void) { return controllerPidTest(); }

static void copy(float to[3], float x, float y, float z) {
  to[0] = x;
  to[1] = y;
  to[2] = z;
}

static void copy_state(struct CrazyflieState* to, const sensorData_t* sensors, const state_t* state) {
  /* the gyro has a time of its own, in us */
  const uint32_t gyro_age_ms = (uint32_t)((usecTimestamp() - sensors->interruptTimestamp) / 1000);
  to->gyro_timestamp = now_ms() - gyro_age_ms;
  copy(to->gyro, sensors->gyro.x, sensors->gyro.y, sensors->gyro.z);
  to->attitude_timestamp = state->attitude.timestamp;
  to->attitude_quaternion[0] = state->attitudeQuaternion.x;
  to->attitude_quaternion[1] = state->attitudeQuaternion.y;
  to->attitude_quaternion[2] = state->attitudeQuaternion.z;
  to->attitude_quaternion[3] = state->attitudeQuaternion.w;
  to->position_timestamp = state->position.timestamp;
  copy(to->position, state->position.x, state->position.y, state->position.z);
  copy(to->velocity, state->velocity.x, state->velocity.y, state->velocity.z);
}

static void copy_setpoint(struct CrazyflieSetpoint* to, const setpoint_t* setpoint) {
  to->timestamp = setpoint->timestamp;
  copy(to->position, setpoint->position.x, setpoint->position.y, setpoint->position.z);
  copy(to->velocity, setpoint->velocity.x, setpoint->velocity.y, setpoint->velocity.z);
  copy(to->acceleration, setpoint->acceleration.x, setpoint->acceleration.y, setpoint->acceleration.z);
  to->yaw = setpoint->attitude.yaw;
  to->yaw_rate = setpoint->attitudeRate.yaw;
  to->velocity_body = setpoint->velocity_body;
  to->mode[0] = (uint8_t)setpoint->mode.x;
  to->mode[1] = (uint8_t)setpoint->mode.y;
  to->mode[2] = (uint8_t)setpoint->mode.z;
  to->mode_yaw = (uint8_t)setpoint->mode.yaw;
}

void controllerOutOfTree(control_t* control, const setpoint_t* setpoint, const sensorData_t* sensors,
                         const state_t* state, const stabilizerStep_t stabilizerStep) {
  if (ready && RATE_DO_EXECUTE(RATE_500_HZ, stabilizerStep)) {
    struct CrazyflieState at;
    struct CrazyflieSetpoint wanted;
    float forces[STABILIZER_NR_OF_MOTORS];
    copy_state(&at, sensors, state);
    copy_setpoint(&wanted, setpoint);
    const uint64_t start_us = usecTimestamp();
    const bool has_forces = pinnquad_flight_step(now_ms(), &at, &wanted, forces, &report);
    step_us = (uint16_t)(usecTimestamp() - start_us);
    /* Off, or flown by hand: the PID controller's, and the module may fly again afterwards. Given up: the PID
     * controller's until then. */
    const bool by_hand =
        setpoint->mode.x == modeDisable && setpoint->mode.y == modeDisable && setpoint->mode.z == modeDisable;
    if (by_hand) gave_up = 0;
    if (!by_hand && !has_forces) gave_up = 1;
    pid_flies = by_hand || gave_up;
    if (!pid_flies) {
      control->controlMode = controlModeForce;
      for (int motor = 0; motor < STABILIZER_NR_OF_MOTORS; motor++) {
        control->normalizedForces[motor] = forces[motor] * force_scale;
      }
    }
  }
  if (pid_flies) controllerPid(control, setpoint, sensors, state, stabilizerStep);
}

PARAM_GROUP_START(pinnquad)
PARAM_ADD(PARAM_FLOAT, forceScale, &force_scale)
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
LOG_ADD(LOG_FLOAT, fallback, &report.fallback_share)
LOG_ADD(LOG_FLOAT, excess, &report.envelope_excess)
LOG_ADD(LOG_INT8, feature, &report.envelope_feature)
LOG_ADD(LOG_UINT32, refused, &report.refused_samples)
LOG_GROUP_STOP(pinnquad)
