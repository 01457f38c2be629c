// SPDX-License-Identifier: MIT
// Parts of which controllers in the loop are composed: inverses, what they see of the flown motion, how they learn.
#pragma once

#include <cstddef>
#include <limits>
#include <type_traits>

#include "flight/block_feed_forward.hpp"
#include "loop/controllers.hpp"
#include "pinnquad/control/filtered_motion.hpp"

namespace programs {

struct PolicyParts {
  using Formula = pinnquad::AnalyticInverse<pinnquad::SwitchedQuadrotor>;

  PolicyParts(const LoopKnowledge& told, const LoopGains& gains)
      : known(told),
        body(quadrotor_with(pinnquad::switched_effects<pinnquad::Quadrotor<double, pinnquad::StandardAtmosphere>>(),
                            told.vehicle.airframe(), told.vehicle.site())),
        rigid_body(body),
        formula(told.vehicle),
        lag_s(told.vehicle.airframe().rise_time_constant_s(0)),
        bias(told.bias),
        at_once(told.bias),
        slower(told.bias),
        filtered_(gains.learning * pinnquad::FilteredMotion<double>::usual_cutoff_rad_s, lag_s, known.delay_s) {
    for (std::size_t i = 0; i < bias.time_constants_s.size(); ++i) {
      bias.time_constants_s[i] /= gains.learning;
      at_once.time_constants_s[i] = 0;
      at_once.most[i] = std::numeric_limits<double>::infinity();  // an increment from tick to tick, not a bias learnt
      slower.time_constants_s[i] = 0.05 / gains.learning;
    }
    bias.across_time_constant_s /= gains.learning;
    bias.roll_pitch_by_noise_s /= gains.learning;
    bias.across_by_noise_s3_m /= gains.learning;
    at_once.across_time_constant_s = 0;
    for (pinnquad::BiasSettings<double>* plain : {&at_once, &slower}) {
      plain->roll_pitch_by_noise_s = plain->across_by_noise_s3_m = plain->across_lead_s = 0;
    }
    slower.across_time_constant_s = 0.05 / gains.learning;
  }

  template <class Inverse, class... Reserve>
  auto adaptive(const Inverse& inverse, const Reserve&... reserve) const {
    using Motion = pinnquad::FlownMotion<double>;
    return pinnquad::AdaptiveInverse<double, Inverse, Motion, Reserve...>(
        inverse, known.vehicle.airframe(), bias, Motion(pinnquad::quick_period_us, lag_s, known.delay_s), reserve...);
  }
  template <class Inverse, class... Reserve>
  auto incremental(const pinnquad::BiasSettings<double>& settings, const Inverse& inverse,
                   const Reserve&... reserve) const {
    return pinnquad::AdaptiveInverse<double, Inverse, pinnquad::FilteredMotion<double>, Reserve...>(
        inverse, known.vehicle.airframe(), settings, filtered_, reserve...);
  }
  template <class Guard>
  AnyFeedForward of_model(const Guard& guard) const {
    return model_inverse(known.model, guard, known.vehicle.site().ground_z_m, known.columns);
  }
  /// Where the model declines, the analytic inverse answers.
  pinnquad::Extend<pinnquad::TrainingGuard, pinnquad::Fallback<Formula>> falls_back() const { return {formula}; }

  const LoopKnowledge& known;
  const pinnquad::SwitchedQuadrotor body;  ///< without drag
  const Formula rigid_body, formula;
  const double lag_s;
  pinnquad::BiasSettings<double> bias, at_once, slower;

 private:
  pinnquad::FilteredMotion<double> filtered_;
};

}  // namespace programs
