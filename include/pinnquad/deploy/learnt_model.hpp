// SPDX-License-Identifier: MIT
// A vehicle that was learnt in flight (control/onboard/), as a model of its own: header and block of what flew, to the
// bit.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/control/onboard/onboard_inverse.hpp"
#include "pinnquad/core/fnv1a.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/deploy/provenance.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/loss/context.hpp"
#include "pinnquad/model/axis_aligned.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"
#include "pinnquad/training/trained_model.hpp"

namespace pinnquad {

namespace detail {
/// The sums of an OnboardInverse as they fly, without what it adds to them in flight: sines, bias, drag across the
/// thrust. u = A y(x), y an affine map of InverseFeatures (control/onboard/affine_inverse.hpp).
template <class Scalar>
using LearntModel =
    TrainedModel<MonotoneBase<InverseFeatures, Scalar>, Context<InverseFeatures, GivenAirframe, AxisCommandOutputs>>;
}  // namespace detail

/// Rows of the flight in which a vehicle was learnt: the envelope of its model is of them.
class LearntRows {
 public:
  using Row = std::array<double, static_cast<std::size_t>(InverseFeatures::size)>;

  /// After a tick of the learner.
  template <class Scalar>
  void note(const OnboardInverse<Scalar>& learner) {
    if (learner.rows() == noted_) return;
    noted_ = learner.rows();
    Scalar x[InverseFeatures::size];
    InverseFeatures::extract(learner.motion(), static_cast<Scalar*>(x));
    Row& row = rows_.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = static_cast<double>(x[i]);
  }
  const std::vector<Row>& rows() const noexcept { return rows_; }
  /// Names the rows by a number.
  std::uint64_t hash() const noexcept {
    detail::Fnv1a fnv;
    for (const Row& row : rows_) {
      for (const double number : row) detail::absorb_number(fnv, number);
    }
    return fnv.hash;
  }
  /// Some, evenly apart: golden vectors.
  template <class Scalar>
  std::vector<typename detail::LearntModel<Scalar>::FeatureVector> some(std::size_t count = 8) const {
    std::vector<typename detail::LearntModel<Scalar>::FeatureVector> some;
    for (std::size_t i = 0; i < count && !rows_.empty(); ++i) {
      auto& vector = some.emplace_back();
      const Row& row = rows_[i * (rows_.size() - 1) / std::max<std::size_t>(1, count - 1)];
      for (std::size_t k = 0; k < row.size(); ++k) vector[k] = static_cast<Scalar>(row[k]);
    }
    return some;
  }

 private:
  std::vector<Row> rows_;
  std::uint32_t noted_ = 0;
};

/// `airframe`: of the name of the one that the learner started from; the model's is that with the slopes that fly.
/// Throws std::invalid_argument, one line, for no row, and for rotors with a thrust curve: their commands are no affine
/// map.
template <class Scalar>
detail::LearntModel<Scalar> learnt_model(const OnboardInverse<Scalar>& learner, const std::string& airframe,
                                         const LearntRows& rows) {
  const Airframe<Scalar> flown = learner.airframe();
  if (rows.rows().empty()) throw std::invalid_argument("learnt model: expected a row of flight, found none");
  for (const RotorMount<Scalar>& rotor : flown.rotors) {
    if (!(rotor.thrust_curve > Scalar(0))) continue;
    throw std::invalid_argument(
        "learnt model: rotors with a thrust curve, whose commands are no affine map of a motion");
  }
  using Model = detail::LearntModel<Scalar>;
  using Base = typename Model::Network;
  using Sum = detail::AffineSum<Scalar>;
  Model model{GivenAirframe(airframe, airframe_in<double>(flown))};
  const detail::AffineInverse<Scalar> inverse = detail::affine_inverse(learner.forward());
  // places among InverseFeatures: own rate and product of the axis, and the rest of AffineSum's
  constexpr int rates = 4, products = 7, velocity = 13, squares = 16;
  for (int k = 0; k < 4; ++k) {
    const Sum& sum = inverse[static_cast<std::size_t>(k)];
    std::array<Scalar, static_cast<std::size_t>(InverseFeatures::size)> by{};
    by[0] = sum.by[Sum::force_z];
    if (k > 0) {
      by[static_cast<std::size_t>(rates + k - 1)] = sum.by[Sum::own_rate];
      by[static_cast<std::size_t>(products + k - 1)] = sum.by[Sum::rate_product];
      model.network.parameters[static_cast<std::size_t>(Base::slopes + k - 1)] = sum.by_turn;
    }
    for (std::size_t i = 0; i < 3; ++i) by[velocity + i] = sum.by[Sum::v_x + i];
    by[squares + 2] = sum.by[Sum::vv_z];
    Base::Threes::each_other([&](int feature, int n) {
      model.network.parameters[static_cast<std::size_t>(Base::weights + k * Base::Threes::others + n)] =
          by[static_cast<std::size_t>(feature)];
    });
    model.network.parameters[static_cast<std::size_t>(Base::intercepts + k)] = sum.constant;
  }
  const std::vector<detail::ColumnStatistics> columns = detail::column_statistics(
      {InverseFeatures::units.begin(), InverseFeatures::units.end()}, [&](const detail::RowVisit& visit) {
        for (const LearntRows::Row& row : rows.rows()) visit(row.data());
      });
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double margin = columns[i].margin(detail::affine_reach(InverseFeatures::units[i]));
    model.envelope_lower[i] = static_cast<Scalar>(columns[i].lowest - margin);
    model.envelope_upper[i] = static_cast<Scalar>(columns[i].highest + margin);
  }
  return model;
}

/// `flight`: name of the log.
template <class Scalar>
Provenance learnt_provenance(const OnboardInverse<Scalar>& learner, const std::string& flight, const LearntRows& rows) {
  constexpr std::array<const char*, 4> names = {"thrust", "roll", "pitch", "yaw"};
  Provenance from;
  from.training_data = "learnt in flight: " + flight;
  from.training_data_hash = rows.hash();
  from.training_rows = rows.rows().size();
  from.loss = "forward regression of each signed sum on board, inverted";
  const auto& certificate = learner.certificate();
  from.lag_removed_s = static_cast<double>(certificate[1].forward.lag.seconds());
  from.sample_period_s = 1e-6 * learner.settings().period_us;
  auto& times_s = from.bias_time_constants_s.emplace();
  std::string learnt, start;
  for (std::size_t k = 0; k < names.size(); ++k) {
    times_s[k] = static_cast<double>(learner.settings().bias.time_constants_s[k]);
    std::string& of = certificate[k].proven ? learnt : start;
    of += (of.empty() ? "" : ", ") + std::string(names[k]);
  }
  if (!learnt.empty()) from.loss += "; proven in flight: " + learnt;
  if (!start.empty()) from.loss += "; the start's: " + start;
  return from;
}

}  // namespace pinnquad
