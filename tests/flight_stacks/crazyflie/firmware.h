/* SPDX-License-Identifier: MIT
 * Stand-in for what the glue of the Crazyflie app takes from the firmware: its types and functions by name, of our own
 * making, with the firmware's meaning (crazyflie_firmware_test.cpp plays its side). The headers beside this one all
 * lead here. */
#ifndef PINNQUAD_TEST_CRAZYFLIE_FIRMWARE_H
#define PINNQUAD_TEST_CRAZYFLIE_FIRMWARE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CONFIG_CONTROLLER_OOT 1
#ifndef WITHOUT_KALMAN
#define CONFIG_ESTIMATOR_KALMAN_ENABLE 1
#endif
#ifndef WITHOUT_BATTERY_COMPENSATION
#define CONFIG_ENABLE_THRUST_BAT_COMPENSATED 1
#endif

#define THRUST_MAX 0.12f /* N per motor, of the stock propellers */
#ifndef MINIMAL_STACK
#define MINIMAL_STACK 150
#endif
#define STABILIZER_TASK_STACKSIZE (3 * (unsigned short)MINIMAL_STACK) /* words */
typedef uint32_t StackType_t;

typedef uint32_t stabilizerStep_t;
#define RATE_500_HZ 500
#define RATE_DO_EXECUTE(rate_hz, step) ((step) % (1000 / (rate_hz)) == 0)
#define M2T(ms) (ms)
#define T2M(ticks) (ticks)
#define DEBUG_PRINT(...) ((void)0)

#define PARAM_GROUP_START(name)
#define PARAM_GROUP_STOP(name)
#define PARAM_ADD(type, name, address)
#define LOG_GROUP_START(name)
#define LOG_GROUP_STOP(name)
#define LOG_ADD(type, name, address)

/* Events with a payload: the records of a uSD card's log. Variables lie packed in `payload`, in the
 * order of the description. */
enum eventtriggerType_e {
  eventtriggerType_uint8 = 1,
  eventtriggerType_uint16,
  eventtriggerType_uint32,
  eventtriggerType_int8,
  eventtriggerType_int16,
  eventtriggerType_int32,
  eventtriggerType_float,
};
typedef struct {
  enum eventtriggerType_e type;
  const char* name;
} eventtriggerPayloadDesc;
typedef struct {
  const char* name;
  const eventtriggerPayloadDesc* payloadDesc;
  uint8_t numPayloadVariables;
  void* payload;
  uint8_t payloadSize;
} eventtrigger;

typedef struct {
  float x, y, z;
} Axis3f;

typedef struct {
  uint32_t timestamp;
  float x, y, z;
} stamped3;

typedef struct {
  uint32_t timestamp;
  float roll, pitch, yaw;
} attitude_t;

typedef struct {
  float x, y, z, w;
} quaternion_t;

typedef struct {
  Axis3f acc, gyro;
  uint64_t interruptTimestamp;
} sensorData_t;

typedef struct {
  attitude_t attitude;
  quaternion_t attitudeQuaternion;
  stamped3 position, velocity, acc;
} state_t;

#define STABILIZER_NR_OF_MOTORS 4
typedef enum { controlModeLegacy, controlModeForceTorque, controlModeForce } control_mode_t;

/* The modes share their bytes: forces overwrite what a PID controller left. */
typedef struct {
  __extension__ union {
    __extension__ struct {
      int16_t roll, pitch, yaw;
      float thrust;
    };
    float normalizedForces[STABILIZER_NR_OF_MOTORS];
  };
  control_mode_t controlMode;
} control_t;

typedef enum { modeDisable, modeAbs, modeVelocity } stab_mode_t;
typedef struct {
  uint32_t timestamp;
  attitude_t attitude, attitudeRate;
  quaternion_t attitudeQuaternion;
  float thrust;
  stamped3 position, velocity, acceleration;
  bool velocity_body;
  struct {
    stab_mode_t x, y, z, roll, pitch, yaw, quat;
  } mode;
} setpoint_t;

#ifdef __cplusplus
extern "C" {
#endif

uint32_t xTaskGetTickCount(void);
void vTaskDelay(uint32_t ticks);
uint64_t usecTimestamp(void);
float pmGetBatteryVoltage(void);
void eventTrigger(const eventtrigger* event);
bool supervisorIsFlying(void);
bool supervisorAreMotorsAllowedToRun(void);
void controllerPidInit(void);
bool controllerPidTest(void);
void controllerPid(control_t* control, const setpoint_t* setpoint, const sensorData_t* sensors, const state_t* state,
                   stabilizerStep_t step);

/* the app's */
void appMain(void);
void controllerOutOfTreeInit(void);
bool controllerOutOfTreeTest(void);
void controllerOutOfTree(control_t* control, const setpoint_t* setpoint, const sensorData_t* sensors,
                         const state_t* state, stabilizerStep_t step);

#ifdef __cplusplus
}
#endif

#endif
