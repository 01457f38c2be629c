// SPDX-License-Identifier: MIT
// An answer that is its own mirror image, exactly and for every input: the mean of what an answer says and of the mirror
// image of what it says to the mirrored question. For vehicles whose left is as their right (dynamics/mirror.hpp), where no
// wind or load tells the sides apart. A network that is shown no heading is as exactly blind to it: PhysicsFeatures.
#pragma once

#include <string_view>

#include "pinnquad/model/composition.hpp"
#include "pinnquad/model/masked.hpp"

namespace pinnquad {

inline namespace PINNQUAD_INSTRUCTION_SET {

/// y(x) = (Inner(x) + S Inner(P x)) / 2 of signed sums (outputs/axis_command_outputs.hpp): S turns the sums about roll and
/// yaw, P the features `Odd...` (see is_odd). Standardised by means of 0 of what is turned, as context_of_mirror_images()
/// makes them: then the commands of the mirrored motion are the mirrored commands. Costs two of `Inner`.
template <class Inner, int... Odd>
struct Symmetrised : PredictorBase<Symmetrised<Inner, Odd...>, typename Inner::Scalar, Inner::inputs, Inner::outputs,
                                   Inner::parameter_count> {
  static_assert(is_predictor<Inner> && Inner::outputs == 4,
                "pinnquad: Symmetrised is of an answer of signed sums (outputs/axis_command_outputs.hpp)");
  static_assert(sizeof...(Odd) > 0 && (... && (Odd >= 0 && Odd < Inner::inputs)),
                "pinnquad: what a mirror turns are features of the answer");
  using Scalar = typename Inner::Scalar;
  using Symmetrised::PredictorBase::forward;

  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    Scalar image[Inner::inputs], said[Inner::outputs];
    mirror(x, static_cast<Scalar*>(image));
    Inner::forward(parameters, x, y);
    Inner::forward(parameters, static_cast<const Scalar*>(image), static_cast<Scalar*>(said));
    for (int k = 0; k < 4; ++k) y[k] = Scalar(0.5) * (k % 2 == 0 ? y[k] + said[k] : y[k] - said[k]);
  }
  static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept {
    Scalar image[Inner::inputs], said[Inner::outputs], by_image[Inner::outputs * Inner::inputs];
    mirror(x, static_cast<Scalar*>(image));
    answer_jacobian<Inner>(parameters, x, y, by_x);
    answer_jacobian<Inner>(parameters, static_cast<const Scalar*>(image), static_cast<Scalar*>(said),
                           static_cast<Scalar*>(by_image));
    for (int k = 0; k < 4; ++k) {
      Scalar* const of_image = by_image + k * Inner::inputs;
      ((of_image[Odd] = -of_image[Odd]), ...);
      y[k] = Scalar(0.5) * (k % 2 == 0 ? y[k] + said[k] : y[k] - said[k]);
      for (int i = 0; i < Inner::inputs; ++i) {
        Scalar& slope = by_x[k * Inner::inputs + i];
        slope = Scalar(0.5) * (k % 2 == 0 ? slope + of_image[i] : slope - of_image[i]);
      }
    }
  }

 private:
  static PINNQUAD_ALWAYS_INLINE void mirror(const Scalar* x, Scalar* image) noexcept {
    for (int i = 0; i < Inner::inputs; ++i) image[i] = x[i];
    ((image[Odd] = -image[Odd]), ...);
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

template <class Inner, int... Odd>
struct Description<Symmetrised<Inner, Odd...>> {
  template <class Sink>
  static constexpr void add(Sink& sink) {
    sink.add(std::string_view("pinnquad::Symmetrised<"));
    Description<Inner>::add(sink);
    detail::describe_numbers(sink, Odd...);
  }
};

namespace detail {

template <class Inner, int... Odd>
struct FormulasOf<Symmetrised<Inner, Odd...>> : FormulasOf<Inner> {};

/// Features that a mirror about the x-z plane turns, and those that it leaves, by name: y of what is a vector, x and z of
/// what turns, a product of an odd and an even one.
constexpr int parity_of(std::string_view name) noexcept {
  constexpr std::string_view odd[] = {"vdot_by", "wdot_x", "wdot_z", "v_by", "w_x",   "w_z",   "roll",
                                      "sin_yaw", "s_y",    "w_yz",   "w_xy", "vv_by", "down_y"};
  constexpr std::string_view even[] = {"vdot_bx", "vdot_bz", "wdot_y", "v_bx",    "v_bz", "w_y",
                                       "pitch",   "cos_yaw", "s_x",    "s_z",     "w_zx", "vv_bx",
                                       "vv_bz",   "down_x",  "down_z", "altitude"};
  for (const std::string_view known : odd) {
    if (name == known) return -1;
  }
  for (const std::string_view known : even) {
    if (name == known) return 1;
  }
  return 0;
}

}  // namespace detail

/// True for a feature that changes its sign in the mirror.
template <class Features>
constexpr bool is_odd(int feature) noexcept {
  return detail::parity_of(Features::names[static_cast<std::size_t>(feature)]) < 0;
}

namespace detail {

template <class Features>
constexpr int odd_count() noexcept {
  int count = 0;
  for (int i = 0; i < Features::size; ++i) count += is_odd<Features>(i) ? 1 : 0;
  return count;
}
template <class Features>
constexpr int nth_odd(int n) noexcept {
  for (int i = 0; i < Features::size; ++i) {
    if (is_odd<Features>(i) && n-- == 0) return i;
  }
  return -1;
}
template <class Features>
constexpr bool parities_known() noexcept {
  for (int i = 0; i < Features::size; ++i) {
    if (parity_of(Features::names[static_cast<std::size_t>(i)]) == 0) return false;
  }
  return true;
}
template <class Inner, class Features, class Indices = std::make_integer_sequence<int, odd_count<Features>()>>
struct SymmetrisedOn;
template <class Inner, class Features, int... N>
struct SymmetrisedOn<Inner, Features, std::integer_sequence<int, N...>> {
  static_assert(parities_known<Features>(),
                "pinnquad: what a mirror does to a feature of this set is not known (model/symmetrised.hpp)");
  using type = Symmetrised<Inner, nth_odd<Features>(N)...>;
};

}  // namespace detail

/// `Inner`, an answer of these features.
template <class Features, class Inner>
using SymmetricPredictor = typename detail::SymmetrisedOn<Inner, Features>::type;

}  // namespace pinnquad
