/* SPDX-License-Identifier: MIT
 * The controller without the firmware, for C: state and set point in the Crazyflie's units in, normalised motor forces
 * out.
 * The glue (out_of_tree_controller.c) copies the fields of the firmware's structures of the same names. */
#ifndef PINNQUAD_CRAZYFLIE_CORE_H
#define PINNQUAD_CRAZYFLIE_CORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* World: x, y, z up, right-handed; body: x forward, y left, z up. Times in ms of the firmware's tick. */
struct CrazyflieState {
  uint32_t gyro_timestamp;
  float gyro[3]; /* deg/s, body */
  uint32_t attitude_timestamp;
  float attitude_quaternion[4]; /* x, y, z, w: body to world, as state_t has it */
  uint32_t position_timestamp;
  float position[3];     /* m, world */
  float velocity[3];     /* m/s, world */
  float battery_voltage; /* V, of this tick, for a model that asks for it */
  bool drives_motors;    /* the forces of the last step reached the motors */
  bool landed;
  uint8_t learning; /* pinnquad::autopilot::Learning, of an app that is built with PINNQUAD_ONBOARD */
};

enum CrazyflieMode { crazyflie_mode_disable = 0, crazyflie_mode_abs = 1, crazyflie_mode_velocity = 2 };

struct CrazyflieSetpoint {
  uint32_t timestamp;
  float position[3];     /* m, world */
  float velocity[3];     /* m/s, world, or body (turned by yaw alone) */
  float acceleration[3]; /* m/s^2, world, without gravity */
  float yaw;             /* deg, counter-clockwise seen from above */
  float yaw_rate;        /* deg/s */
  bool velocity_body;
  float attitude_quaternion[4]; /* x, y, z, w: its yaw counts where mode_yaw does not ask and mode_quat is abs */
  uint8_t mode[3];              /* CrazyflieMode of x, y, z */
  uint8_t mode_yaw;
  uint8_t mode_quat;
};

/* The controller's report: the firmware's log variables. */
struct CrazyflieReport {
  uint32_t asked; /* predictions since the start */
  uint32_t refused_samples;
  float fallback_share;  /* of the predictions */
  float envelope_excess; /* how far the worst feature lay outside, in half-widths of its range */
  float lift;            /* how much of its thrust it used, 0 to 1: 0 idles on the ground */
  int8_t envelope_feature;
  uint8_t reaction;     /* pinnquad::autopilot::Reaction */
  uint8_t status;       /* pinnquad::Status */
  uint8_t cause;        /* pinnquad::Status of the network alone */
  uint8_t stale_inputs; /* bit 0 gyro, 1 attitude, 2 position, 3 set point, 4 battery voltage */
  uint8_t bias_status;  /* pinnquad::Status of the network's bias: limited at a bound, warming_up where it fades */
};

/* Opens and tests a model block; its address is a multiple of 8 and it stays there. 0, or a pinnquad::Status.
 * A later model takes the place of the one that flies, at the next step. */
uint8_t pinnquad_flight_offer_model(const void* block, size_t length);

/* The first call of all, whoever makes it; a later one changes nothing. `most_thrust_N`: the platform's thrust of one
 * motor where its normalised force is 1; forces stay within it. Returns the factor from a force of pinnquad_flight_step
 * to one of the platform: the greatest thrust of a rotor of the model's airframe over the platform's. */
float pinnquad_flight_start(float most_thrust_N);

/* True once a model was accepted. */
bool pinnquad_flight_ready(void);

/* One tick. `forces`: thrust of motors M1..M4 over their greatest, 0..1. False: the controller has none, `forces` is
 * untouched and another controller must take over. `report` is written either way. A set point that leaves one
 * of the three axes disabled (motors off, or flown by hand) is not this controller's: false. */
bool pinnquad_flight_step(uint32_t now_ms, const struct CrazyflieState* state, const struct CrazyflieSetpoint* setpoint,
                          float forces[4], struct CrazyflieReport* report);

#ifdef __cplusplus
}
#endif

#endif
