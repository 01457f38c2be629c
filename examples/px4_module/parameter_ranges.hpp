// SPDX-License-Identifier: MIT
// The ranges of the module's parameters, as module.yaml has them: PX4 shows those to the ground station and keeps to
// none of them. Pure C++17.
#pragma once

namespace pinnquad_px4 {

struct ParameterRange {
  const char* name;
  float least, most;
  bool at_start;  ///< read then alone

  /// False for NaN.
  bool holds(float value) const noexcept { return value >= least && value <= most; }
};

inline constexpr ParameterRange parameter_ranges[] = {
    {"PQ_OUT_MIN", 0.0f, 0.08f, true},    {"PQ_AGE_RATES", 2.0f, 50.0f, true}, {"PQ_AGE_ATT", 2.0f, 100.0f, true},
    {"PQ_AGE_POS", 20.0f, 1000.0f, true}, {"PQ_AGE_SP", 50.0f, 5000.0f, true}, {"PQ_G_POS", 0.2f, 4.0f, true},
    {"PQ_G_VEL", 0.5f, 8.0f, true},       {"PQ_G_TILT", 2.0f, 20.0f, true},    {"PQ_G_YAW", 0.5f, 8.0f, true},
    {"PQ_G_RATE", 5.0f, 60.0f, true},     {"PQ_G_YAWRATE", 1.0f, 30.0f, true}, {"PQ_V_XY", 1.0f, 20.0f, true},
    {"PQ_V_UP", 0.5f, 8.0f, true},        {"PQ_V_DN", 0.5f, 5.0f, true},       {"PQ_TKO_T", 0.1f, 5.0f, true},
    {"PQ_BIAS_T", 0.0f, 5.0f, true},      {"PQ_BIAS_T_ROT", 0.0f, 5.0f, true}, {"PQ_BIAS_MAX", 0.0f, 2.4f, true},
    {"PQ_BIAS_ACC", 0.0f, 5.0f, true},    {"PQ_BIAS_DELAY", 0.0f, 0.1f, true}, {"PQ_RECORD", 0.0f, 1.0f, false},
    {"PQ_STK_XY", 0.5f, 12.0f, false},    {"PQ_STK_Z", 0.2f, 5.0f, false},     {"PQ_STK_YAW", 0.1f, 3.0f, false},
    {"PQ_AIR_RHO", 0.7f, 1.6f, true},     {"PQ_THR_CURVE", -1.0f, 1.0f, true}, {"PQ_BAT_SCALE", 0.0f, 1.0f, false},
    {"PQ_ONBOARD", 0.0f, 3.0f, false}};

struct OutOfRange {
  const ParameterRange* range{nullptr};
  float value{0};
};

/// The first parameter that is beyond its range; `range` is nullptr if all are within. `value_of(name)` is its value.
template <class ValueOf>
OutOfRange out_of_range(const ValueOf& value_of) noexcept {
  for (const ParameterRange& range : parameter_ranges) {
    const float value = value_of(range.name);
    if (!range.holds(value)) return {&range, value};
  }
  return {};
}

}  // namespace pinnquad_px4
