// SPDX-License-Identifier: MIT
// Callables of Python as effects: wind, and a force and a torque.
#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <string>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/rotation.hpp"
#include "python/effects.hpp"

namespace python {

namespace {

using namespace pinnquad;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
thread_local std::exception_ptr failure;
thread_local Vector3<double> place_m;  ///< where the air was asked last: a force's condition has the height alone

/// `call()` with the GIL; after a failure not called again, until that is thrown.
template <class Call>
void guarded(const Call& call) noexcept {
  if (failure) return;
  const py::gil_scoped_acquire with_gil;
  try {
    call();
  } catch (...) {
    failure = std::current_exception();
  }
}

py::array_t<double> row_of(const double* numbers, std::size_t count) {
  return py::array_t<double>({static_cast<py::ssize_t>(1), static_cast<py::ssize_t>(count)}, numbers);
}

}  // namespace

void write_motion(double* row, const Vector3<double>& position_m, const Vector3<double>& velocity_m_s,
                  const Vector3<double>& through_air_m_s, const Quaternion<double>& attitude,
                  const Vector3<double>& body_rates_rad_s, const std::array<double, rotor_count>& rotor_speeds_rev_s,
                  double time_s) {
  const auto add = [&row](const Vector3<double>& vector) { row = std::copy_n(vector.data(), 3, row); };
  add(position_m);
  add(velocity_m_s);
  add(through_air_m_s);
  for (const double part : {attitude.w, attitude.x, attitude.y, attitude.z}) *row++ = part;
  add(body_rates_rad_s);
  row = std::copy(rotor_speeds_rev_s.begin(), rotor_speeds_rev_s.end(), row);
  *row = time_s;
}

bool failed() noexcept { return failure != nullptr; }

void throw_failure() {
  if (failure) std::rethrow_exception(std::exchange(failure, nullptr));
}

// Not inlined: a vehicle's step is flattened, and would hold them whole many times (1.9 GB of compiler).
PINNQUAD_NOINLINE void OwnWind::surroundings(Surroundings<double>& air) const noexcept {
  Vector3<double> wind_m_s(no_number, no_number, no_number);
  guarded([&] {
    const py::array_t<double> time_s(1, &air.time_s);
    wind_m_s = wind_of(called, time_s, row_of(triple(air.position_m).data(), 3))[0];
  });
  air.wind_m_s += wind_m_s;
  if (failure) air.status = Status::output_not_finite;
}

PINNQUAD_NOINLINE void OwnWrench::surroundings(Surroundings<double>& air) const noexcept { place_m = air.position_m; }

PINNQUAD_NOINLINE Wrench<double> OwnWrench::wrench(const RotorCondition<double>& condition,
                                                   const Airframe<double>& airframe) const noexcept {
  Wrench<double> result;
  result.force_N = result.torque_N_m = Vector3<double>(no_number, no_number, no_number);
  guarded([&] {
    std::array<double, motion_numbers> row;
    const Quaternion<double>& q = condition.attitude;
    std::array<double, rotor_count> speeds_rev_s;
    const double density = condition.air_density_kg_m3 / standard_air_density_kg_m3<double>;
    for (std::size_t i = 0; i < rotor_count; ++i) {  // thrust over that of full speed in this air
      const double most_N = airframe.rotors[i].thrust_scale * airframe.max_rotor_thrust_N() * density;
      speeds_rev_s[i] = airframe.max_rotor_speed_rev_s * std::sqrt(std::max(0.0, condition.rotor_thrust_N[i] / most_N));
    }
    write_motion(row.data(), place_m, body_to_world(q, condition.ground_velocity_m_s),
                 body_to_world(q, condition.air_relative_velocity_m_s), q, condition.body_rates_rad_s, speeds_rev_s,
                 condition.time_s);
    const auto [forces, torques] = wrenches_of(called, row_of(row.data(), row.size()));
    result.force_N = world_to_body(q, forces[0]);
    result.torque_N_m = torques[0];
  });
  return result;
}

Vectors vectors_of(const char* name, const py::object& given, std::size_t count) {
  Vectors result(count, Vector3<double>::Zero());
  if (given.is_none()) return result;
  const py::array_t<double> rows = doubles(name, given);
  const bool one = rows.ndim() == 1 && rows.shape(0) == 3;
  if (!one && (rows.ndim() != 2 || static_cast<std::size_t>(rows.shape(0)) != count || rows.shape(1) != 3)) {
    throw py::value_error(std::string(name) + " must be (3,) or (" + std::to_string(count) + ", 3), found " +
                          py::str(rows.attr("shape")).cast<std::string>());
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double* const v = rows.data() + (one ? 0 : 3 * i);
    if (!is_finite(v[0]) || !is_finite(v[1]) || !is_finite(v[2])) {
      throw py::value_error(std::string(name) + ", vehicle " + std::to_string(i) + ": expected finite numbers");
    }
    result[i] = Vector3<double>(v[0], v[1], v[2]);
  }
  return result;
}

Vectors wind_of(py::handle called, const py::array_t<double>& time_s, const py::array_t<double>& position_m) {
  const py::object wind = called(time_s, position_m);
  if (wind.is_none()) throw py::type_error("effects: wind_m_s(time_s, position_m) returned None, expected (rows, 3)");
  return vectors_of("effects: wind_m_s()", wind, static_cast<std::size_t>(position_m.shape(0)));
}

std::pair<Vectors, Vectors> wrenches_of(py::handle called, const py::array_t<double>& motions) {
  static const py::handle motion = py::object(py::module_::import("pinnquad.effects").attr("Motion")).release();
  const py::object made = called(motion(motions));
  if (!py::isinstance<py::tuple>(made) || py::len(made) != 2) {
    throw py::type_error("effects: wrench(motion) must return (force_N, torque_N_m), either may be None; found " +
                         py::repr(made).cast<std::string>());
  }
  const auto count = static_cast<std::size_t>(motions.shape(0));
  return {vectors_of("effects: wrench(), force_N", made[py::int_(0)], count),
          vectors_of("effects: wrench(), torque_N_m", made[py::int_(1)], count)};
}

}  // namespace python
