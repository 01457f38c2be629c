/* SPDX-License-Identifier: MIT
 * When a sample of the estimator came. Of the firmware's estimators only the UKF stamps what it writes; Kalman and
 * complementary leave 0. Where there is no stamp, a sample came when its bits changed: an estimator that stops leaves
 * them as they are, and then they age as stamped ones do. */
#ifndef PINNQUAD_CRAZYFLIE_SAMPLE_CLOCK_H
#define PINNQUAD_CRAZYFLIE_SAMPLE_CLOCK_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

struct CrazyflieSampleClock {
  float last[6];
  uint32_t changed_ms;
  bool came;
};

/* The time of a sample of `count` numbers, at most 6. */
static inline uint32_t crazyflie_sample_time(struct CrazyflieSampleClock* clock, uint32_t stamp_ms, uint32_t now_ms,
                                             const float* numbers, unsigned count) {
  if (stamp_ms != 0) return stamp_ms;
  if (!clock->came || memcmp(clock->last, numbers, count * sizeof(float)) != 0) {
    memcpy(clock->last, numbers, count * sizeof(float));
    clock->changed_ms = now_ms;
    clock->came = true;
  }
  return clock->changed_ms;
}

#endif
