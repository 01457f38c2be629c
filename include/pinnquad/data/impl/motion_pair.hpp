// SPDX-License-Identifier: MIT
// Bodies of motion_pair.hpp.
#pragma once

#include "pinnquad/data/motion_pair.hpp"

namespace pinnquad::detail {

PINNQUAD_BODY bool is_plain(const std::vector<double>& gains) {
  constexpr double deviations = 3;
  double sum = 0, squares = 0;
  for (const double gain : gains) {
    sum += gain;
    squares += gain * gain;
  }
  return sum > 0 && sum > deviations * std::sqrt(squares);
}

PINNQUAD_BODY std::size_t block_count(double duration_s) {
  constexpr double most_blocks = 40, shortest_block_s = 0.2;
  return static_cast<std::size_t>(std::clamp(std::floor(duration_s / shortest_block_s), 1.0, most_blocks));
}

PINNQUAD_BODY std::vector<double> block_weights(const std::vector<double>& energies) {
  constexpr double usual = 0.8;
  std::vector<double> sorted;
  for (const double energy : energies) {
    if (energy > 0) sorted.push_back(energy);
  }
  std::vector<double> weights(energies.size(), 1.0);
  if (sorted.empty()) return weights;
  const auto at = static_cast<std::ptrdiff_t>(usual * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
  const double bar = sorted[static_cast<std::size_t>(at)];
  for (std::size_t block = 0; block < weights.size(); ++block) {
    if (energies[block] > bar) weights[block] = bar / energies[block];
  }
  return weights;
}

PINNQUAD_BODY bool can_be_of_axis(const MotionSums& sums, Eigen::Index axis, Eigen::Index column, double correlation) {
  constexpr double slack = 4;
  const double size = std::sqrt(sums.integrals[column] / sums.changes[axis]);
  for (const double unit : {1.0, degrees_per_radian, 1 / degrees_per_radian}) {
    if (std::abs(correlation) < slack * std::min(size / unit, unit / size)) return true;
  }
  return false;
}

PINNQUAD_BODY std::optional<AxisMistake> find_axis_mistake(const MotionBlocks& sums, double follows, double better) {
  constexpr double alike = 0.1;  // an axis that its own column follows better is not what another column holds
  constexpr double straight = 0.9, most_factor = 2;  // of a column that is its axis's but for a factor
  constexpr double loosely_related = 0.6,
                   great_factor = 20;  // the same where noise is left, of a factor that no noise makes
  for (Eigen::Index column = 0; column < 3; ++column) {
    const double own = sums.correlation(column, column);
    Eigen::Index best = column;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (std::abs(sums.correlation(axis, column)) > std::abs(sums.correlation(best, column))) best = axis;
    }
    const double fits = sums.correlation(best, column), sign = fits < 0 ? -1 : 1;
    const auto gain = [&](const MotionSums& block) {
      return sign * sums.correlation(best, column, block) - sums.correlation(column, column, block);
    };
    const bool is_free = best == column || sums.correlation(best, best) < std::abs(fits) + alike;
    if (std::abs(fits) > follows && std::abs(fits) > own + better && is_free &&
        can_be_of_axis(sums, best, column, fits) && is_plain(sums.each(gain))) {
      return AxisMistake{column, best, fits < 0, 1};
    }
    if (!(own > loosely_related)) continue;
    const double factor = own > straight ? sums.integrals[column] / sums.products(column, column)
                                         : std::sqrt(sums.integrals[column] / sums.changes[column]);
    const double limit = own > straight ? most_factor : great_factor;
    const auto left = [&](const MotionSums& block, double over) {
      return (block.integrals[column] / over - 2 * block.products(column, column)) / over;
    };
    const auto gain_in_unit = [&](const MotionSums& block) { return left(block, 1) - left(block, factor); };
    if ((factor > limit || factor < 1 / limit) && is_plain(sums.each(gain_in_unit)))
      return AxisMistake{column, column, false, factor};
  }
  return std::nullopt;
}

}  // namespace pinnquad::detail

namespace pinnquad::detail {

PINNQUAD_BODY void MotionSums::add(const Vector3<double>& change, const Vector3<double>& integral) {
  products += change * integral.transpose();
  changes += change.cwiseAbs2();
  integrals += integral.cwiseAbs2();
  steps += 1;
}

PINNQUAD_BODY void MotionSums::add(const MotionSums& other, double weight) {
  products += weight * other.products;
  changes += weight * other.changes;
  integrals += weight * other.integrals;
  steps += weight * other.steps;
}

PINNQUAD_BODY MotionBlocks::MotionBlocks(std::vector<MotionSums> of) : blocks(std::move(of)) {
  std::vector<double> energies;
  for (const MotionSums& block : blocks) energies.push_back(block.changes.sum() + block.integrals.sum());
  const std::vector<double> weights = block_weights(energies);
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    MotionSums weighted;
    weighted.add(blocks[block], weights[block]);
    blocks[block] = weighted;
    add(weighted, 1);
  }
}

PINNQUAD_BODY double MotionBlocks::correlation(Eigen::Index axis, Eigen::Index column, const MotionSums& block) const {
  constexpr double smallest_change = 1e-3, digits = 1e-5;  // rad, rad/s, m/s, m: root mean square over a step
  const double more = std::max(changes[axis], integrals[column]), less = std::min(changes[axis], integrals[column]);
  if (!(more > smallest_change * smallest_change * steps) || !(less > digits * digits * steps)) return 0;
  return block.products(axis, column) / std::sqrt(changes[axis] * integrals[column]);
}

PINNQUAD_BODY std::array<bool, 3> MotionBlocks::moving() const {
  constexpr double smallest_change = 1e-3;
  std::array<bool, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<Eigen::Index>(axis);
    result[axis] = changes[at] + integrals[at] > smallest_change * smallest_change * steps;
  }
  return result;
}

PINNQUAD_BODY double MotionBlocks::agreement(const std::array<bool, 3>& of) const {
  return std::count(of.begin(), of.end(), true) > 0 ? agreement(of, *this) : 1;
}

PINNQUAD_BODY double MotionBlocks::agreement(const std::array<bool, 3>& of, const MotionSums& block) const {
  double sum = 0, axes = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<Eigen::Index>(axis);
    const double squares = changes[at] + integrals[at];
    if (!of[axis]) continue;
    sum += squares > 0 ? 2 * block.products(at, at) / squares : 0;
    axes += 1;
  }
  return axes > 0 ? sum / axes : 0;
}

PINNQUAD_BODY bool MotionBlocks::agrees_less_than(const MotionBlocks& so, const std::array<bool, 3>& axes) const {
  std::vector<double> gains;
  for (std::size_t block = 0; block < std::min(blocks.size(), so.blocks.size()); ++block) {
    gains.push_back(so.agreement(axes, so.blocks[block]) - agreement(axes, blocks[block]));
  }
  return is_plain(gains);
}

PINNQUAD_BODY bool MotionBlocks::confirms(Eigen::Index axis) const {
  constexpr double loosely_related = 0.6;
  return correlation(axis, axis) > loosely_related &&
         is_plain(each([&](const MotionSums& block) { return correlation(axis, axis, block); }));
}

PINNQUAD_BODY MotionBlocks MotionSteps::sums() const {
  const double duration_s = stretch_ends_s.empty() ? 0 : stretch_ends_s.back();
  std::vector<MotionSums> blocks(block_count(duration_s));
  for (const Step& step : steps) {
    const auto block = static_cast<std::size_t>(step.begin_s / duration_s * static_cast<double>(blocks.size()));
    blocks[std::min(block, blocks.size() - 1)].add(step.changed, step.integral);
  }
  return MotionBlocks(std::move(blocks));
}

PINNQUAD_BODY std::optional<double> MotionSteps::lateness_s(const std::vector<double>& time_s,
                                                            const std::vector<Vector3<double>>& integral) const {
  constexpr double longest_s = 0.5, shortest_s = 0.1, grid_s = 0.02;
  constexpr double enough = 0.6, left = 0.4;
  const auto sums_at = [&](double late_s) {
    MotionSteps late{{}, stretch_ends_s};
    std::size_t row = 0;
    const auto integral_at = [&](double at_s) -> Vector3<double> {
      while (row > 0 && time_s[row] > at_s) --row;
      while (row + 2 < time_s.size() && time_s[row + 1] <= at_s) ++row;
      const double share = (at_s - time_s[row]) / (time_s[row + 1] - time_s[row]);
      return integral[row] + share * (integral[row + 1] - integral[row]);
    };
    for (const Step& step : steps) {
      const double first_s = step.begin_s - late_s, last_s = step.end_s - late_s;
      const double least_s = step.stretch > 0 ? stretch_ends_s[step.stretch - 1] : 0;
      if (first_s < least_s || last_s > stretch_ends_s[step.stretch]) continue;
      const Vector3<double> first = integral_at(first_s);
      late.steps.push_back({step.begin_s, step.end_s, step.changed, integral_at(last_s) - first, step.stretch});
    }
    return late.sums();
  };
  const MotionBlocks as_it_stands = sums();
  const std::array<bool, 3> moving = as_it_stands.moving();
  const double now = as_it_stands.agreement(moving);
  double late_s = 0, most = now;
  for (int k = -static_cast<int>(longest_s / grid_s); k <= static_cast<int>(longest_s / grid_s); ++k) {
    const MotionBlocks at = sums_at(grid_s * k);
    if (!(at.agreement(moving) > most)) continue;
    most = at.agreement(moving);
    late_s = grid_s * k;
  }
  const bool found = std::abs(late_s) > shortest_s - grid_s / 2 && most > enough && 1 - most < left * (1 - now) &&
                     as_it_stands.agrees_less_than(sums_at(late_s), moving);
  return found ? std::optional<double>(late_s) : std::nullopt;
}

}  // namespace pinnquad::detail
