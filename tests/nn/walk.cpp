// SPDX-License-Identifier: MIT
// Layers that a walk takes as one, in which order, and how often they repeat: on types, before any kernel runs them.
#include "pinnquad/nn/walk.hpp"

#include <doctest/doctest.h>

#include <string>

#include "pinnquad/nn/network.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/tanh.hpp"

using namespace pinnquad;
using detail::Way;

namespace {

/// Fuses every element-wise layer with a layer that has parameters.
struct Kernel {
  template <class Layer, class Elementwise>
  static constexpr bool fuses = (Layer::parameter_count > 0);
};

/// Writes "index" or "index+" for a fused step, "xN" behind one that is a loop of N.
template <bool Loops>
struct Writer {
  template <class Step, class State>
  static constexpr int together = Loops ? Step::count_alike() : 1;
  template <class Step>
  std::string visit(const std::string& before) const {
    constexpr int count = together<Step, std::string>;
    return before + " " + std::to_string(Step::index) + (Step::fused ? "+" : "") +
           (count > 1 ? "x" + std::to_string(count) : "");
  }
};

using D = Dense<6>;
template <class... Specs>
using Net = Network<float, InputSize<6>, Specs...>;

template <class Network, class Kernel, bool Loops = true>
std::string forward() {
  return detail::walk_forward<Network, Kernel>(Writer<Loops>{}, std::string());
}
template <class Network, class Kernel, bool Loops = true>
std::string back() {
  return detail::walk_back<Network, Kernel>(Writer<Loops>{}, std::string());
}

}  // namespace

TEST_CASE("forward: a layer takes the one activation behind it; equal steps are a row") {
  CHECK(forward<Net<D>, Kernel>() == " 0");
  CHECK(forward<Net<D, Relu>, Kernel>() == " 0+");
  CHECK(forward<Net<Relu, D, Relu, Relu, D>, Kernel>() == " 0 1+ 3 4");
  CHECK(forward<Net<D, Relu, D, Relu, D, Relu, D>, Kernel>() == " 0+x3 6");
  CHECK(forward<Net<D, Relu, D, Tanh, D, Tanh, D, D>, Kernel>() == " 0+ 2+x2 6x2");
  CHECK(forward<Net<D, Relu, D, Relu, Dense<3>>, Kernel, false>() == " 0+ 2+ 4");
  CHECK(forward<Net<D, Relu, D, Relu>, detail::FusesNothing>() == " 0 1 2 3");
}

TEST_CASE("back: a layer takes the one activation before it") {
  CHECK(back<Net<D, Relu, D>, Kernel>() == " 2+ 0");
  CHECK(back<Net<Relu, D, Relu, Relu, D, Tanh>, Kernel>() == " 5 4+ 2 1+");
  CHECK(back<Net<D, Relu, D, Relu>, detail::FusesNothing>() == " 3 2 1 0");
}

TEST_CASE("which layer runs with the one before it") {
  using N = Net<Relu, D, Relu, Relu, D>;
  CHECK_FALSE(detail::runs_with_layer_before<N, Kernel, 0>());
  CHECK_FALSE(detail::runs_with_layer_before<N, Kernel, 1>());
  CHECK(detail::runs_with_layer_before<N, Kernel, 2>());
  CHECK_FALSE(detail::runs_with_layer_before<N, Kernel, 3>());
  CHECK_FALSE(detail::runs_with_layer_before<N, Kernel, 4>());
}

TEST_CASE("where a step's numbers stand among those of the network") {
  using N = Net<Dense<5>, Tanh, Dense<3>>;
  using First = detail::Step<N, Kernel, 0>;
  using Last = detail::Step<N, Kernel, 2>;
  CHECK(First::sums_offset == 0);
  CHECK(First::outputs_offset == 5);
  CHECK(Last::outputs_offset == 10);
  CHECK(Last::parameters_offset == 35);
  CHECK(First::next == 2);
  CHECK((!First::last && Last::last));
  CHECK((detail::Step<N, Kernel, 2, Way::back>::next == 0));
}
