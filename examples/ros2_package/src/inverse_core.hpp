// SPDX-License-Identifier: MIT
// The part of the node that is pinnquad's: what ROS says in its frames (REP 103: world ENU, body FLU) and with time
// stamps becomes motor commands, or a word that says why not. It knows nothing of ROS.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "pinnquad/core/rotation.hpp"
#include "pinnquad/flight.hpp"

namespace pinnquad_ros2 {

struct Settings {
  double state_age_limit_s{0.02};    ///< a state this old is stale
  double request_age_limit_s{0.02};  ///< so is a request for accelerations
  bool clips{true};  ///< commands beyond 0 to 1 are clipped to it (`limited`), else refused (`outside_limits`)
};

/// The vehicle's motion, of nav_msgs/Odometry.
struct Motion {
  pinnquad::Quaternion<float> attitude{};                                        ///< FLU to ENU
  pinnquad::Vector3<float> velocity_m_s = pinnquad::Vector3<float>::Zero();      ///< FLU
  pinnquad::Vector3<float> body_rates_rad_s = pinnquad::Vector3<float>::Zero();  ///< FLU
};

struct Answer {
  /// Thrust over greatest thrust: front right, rear left, front left, rear right. NaN where it was refused.
  std::array<float, pinnquad::rotor_count> commands{};
  const char* status{""};  ///< a pinnquad::Status, "stale_state" or "stale_request"
  bool has_commands{false};
  /// How far the feature that is furthest outside lies beyond the envelope, in half-widths of it; 0 inside, NaN where
  /// the model was not asked.
  float beyond_envelope{std::numeric_limits<float>::quiet_NaN()};
  const char* worst_feature{""};  ///< that feature
  /// Of the features from the training flights (docs/trust.md); NaN where it was not measured.
  float squared_distance{std::numeric_limits<float>::quiet_NaN()};
};

/// False for a stamp of time 0, which is none, and for one of the future: under use_sim_time the clock says 0 until its
/// first tick, and may begin anew.
inline bool is_fresh(std::int64_t stamp_ns, std::int64_t now_ns, double limit_s) noexcept {
  const double age_s = 1e-9 * static_cast<double>(now_ns - stamp_ns);
  return stamp_ns > 0 && age_s >= 0 && age_s < limit_s;
}

/// `Distance`: nothing, or JointDistance of the model's limits of trust.
template <class Model, class... Distance>
class InverseCore {
  using Scalar = typename Model::Scalar;
  static_assert(
      std::is_same_v<typename Model::Inputs, pinnquad::MotionInputs<Scalar>>,
      "pinnquad: this node knows the motion alone: no altitude, no column, no past. Train a model without them");
  using Checked = pinnquad::Extend<pinnquad::TrainingGuard, Distance...>;
  using Clipping = pinnquad::InverseDynamics<Model, pinnquad::Extend<Checked, pinnquad::ClipCommands<>>>;
  using Refusing = pinnquad::InverseDynamics<Model, pinnquad::Extend<Checked, pinnquad::RefuseCommands<>>>;

 public:
  InverseCore() = default;
  explicit InverseCore(const Settings& settings) noexcept : settings_(settings) {}

  /// The model's golden vectors, before the first command.
  pinnquad::Status self_test() const noexcept { return pinnquad::self_test(Clipping()); }

  void set_motion(const Motion& motion, std::int64_t stamp_ns) noexcept {
    inputs_.attitude = attitude(pinnquad::swap_enu_flu_ned_frd(motion.attitude));
    inputs_.velocity_m_s = frd(motion.velocity_m_s);
    inputs_.body_rates_rad_s = frd(motion.body_rates_rad_s);
    motion_stamp_ns_ = stamp_ns;
  }

  /// Commands for the derivatives of body velocity and body rates, FLU, asked for at `stamp_ns`.
  Answer answer(const pinnquad::Vector3<float>& linear_m_s2, const pinnquad::Vector3<float>& angular_rad_s2,
                std::int64_t stamp_ns, std::int64_t now_ns) const noexcept {
    Answer answer;
    answer.commands.fill(std::numeric_limits<float>::quiet_NaN());
    if (!is_fresh(motion_stamp_ns_, now_ns, settings_.state_age_limit_s)) {
      answer.status = "stale_state";
    } else if (!is_fresh(stamp_ns, now_ns, settings_.request_age_limit_s)) {
      answer.status = "stale_request";
    } else {
      typename Model::Inputs inputs = inputs_;
      inputs.linear_acceleration_m_s2 = frd(linear_m_s2);
      inputs.angular_acceleration_rad_s2 = frd(angular_rad_s2);
      settings_.clips ? ask(Clipping(), inputs, answer) : ask(Refusing(), inputs, answer);
    }
    return answer;
  }

 private:
  static pinnquad::Vector3<Scalar> frd(const pinnquad::Vector3<float>& flu) noexcept {
    return pinnquad::swap_flu_frd(flu).template cast<Scalar>();
  }
  static pinnquad::Quaternion<Scalar> attitude(const pinnquad::Quaternion<float>& q) noexcept {
    return {Scalar(q.w), Scalar(q.x), Scalar(q.y), Scalar(q.z)};
  }

  template <class Inverse>
  static void ask(const Inverse& inverse, const typename Model::Inputs& inputs, Answer& answer) noexcept {
    pinnquad::Commands<Scalar> commands{};
    typename Inverse::Report report;
    const pinnquad::Status status = inverse.predict(inputs, commands, report);
    answer.status = pinnquad::to_string(status);
    answer.has_commands = pinnquad::has_output(status);
    for (std::size_t i = 0; i < pinnquad::rotor_count && answer.has_commands; ++i) {
      answer.commands[i] = static_cast<float>(commands[i]);
    }
    if (status == pinnquad::Status::not_finite || status == pinnquad::Status::not_unit_quaternion) return;
    answer.beyond_envelope = 0;
    if (report.worst_feature >= 0) {
      const auto worst = static_cast<std::size_t>(report.worst_feature);
      answer.beyond_envelope = static_cast<float>(report.excess[worst]);
      answer.worst_feature = Model::Features::names[worst];
    }
    if (report.squared_distance > 0) answer.squared_distance = static_cast<float>(report.squared_distance);
  }

  Settings settings_{};
  typename Model::Inputs inputs_{};
  std::int64_t motion_stamp_ns_{0};
};

}  // namespace pinnquad_ros2
