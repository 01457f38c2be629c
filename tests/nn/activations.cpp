// SPDX-License-Identifier: MIT
// Smooth activations against values of 40 digits (mpmath 1.3.0: PyTorch's formulas and their derivatives), and what
// every element-wise layer owes: packs as scalars, NaN goes through, nothing overflows.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>

#include "pinnquad/nn/activations.hpp"
#include "support/packs.hpp"

using namespace pinnquad;

namespace {

/// v, activate(v), its derivative.
struct Row {
  double v, y, slope;
};
template <class Spec>
extern const Row table[8];
// Gelu: v (1 + erf(v / sqrt 2)) / 2. Silu: v / (1 + exp(-v)). Softplus: log(1 + exp(v)). Sine: sin(v).
// GeluTanh: v (1 + tanh(sqrt(2 / pi) (v + 0.044715 v^3))) / 2. Mish: v tanh(log(1 + exp(v))). HardSwish:
// v min(max(v + 3, 0), 6) / 6. Softsign: v / (1 + |v|). These, and Elu: exp(v) - 1 below 0, by Python's decimal.
template <>
const Row table<Gelu>[8] = {{-12, -2.1317785344932148e-32, -2.5578956616748956e-31},
                            {-5, -1.4332578593959696e-6, -7.1469460017922946e-6},
                            {-2.5, -0.015524163314440338, -0.037611085908145208},
                            {-0.25, -0.10032341857926907, 0.30462664511636397},
                            {0.0009765625, 4.8866171094607475e-4, 0.50077918389371313},
                            {1, 0.84134474606854295, 1.0833154705876863},
                            {3, 2.9959503059051097, 1.0119456472041839},
                            {20, 20.0, 1.0}};
template <>
const Row table<GeluTanh>[8] = {{-6, -8.439646700762297e-11, -7.709973930953696e-10},
                                {-5, -2.291796196629506e-07, -1.5463619875325946e-06},
                                {-2.5, -0.015084266089998582, -0.037951576212666184},
                                {-0.25, -0.100324649298315, 0.30464590484893955},
                                {0.0009765625, 0.00048866171094577538, 0.5007791838924871},
                                {1, 0.84119199060827665, 1.0829640838457826},
                                {3, 2.9963626079182268, 1.0115841666309697},
                                {20, 20.0, 1.0}};
template <>
const Row table<Mish>[8] = {{-12, -7.3730321731865867e-05, -6.7585901746137732e-05},
                            {-5, -0.033576237730161704, -0.026747498019901932},
                            {-2.5, -0.19681620390653334, -0.10974357275018569},
                            {-0.25, -0.12992696367914103, 0.43981560172180517},
                            {0.0009765625, 0.00058624266083837301, 0.6006249540527645},
                            {1, 0.86509838826731034, 1.0490362200997922},
                            {3, 2.9865350049679575, 1.0211069109294437},
                            {20, 20.0, 1.0000000000000002}};
template <>
const Row table<HardSwish>[8] = {{-12, 0.0, 0.0},
                                 {-5, 0.0, 0.0},
                                 {-2.5, -0.20833333333333334, -0.33333333333333331},
                                 {-0.25, -0.11458333333333333, 0.41666666666666669},
                                 {0.0009765625, 0.00048844019571940101, 0.50032552083333337},
                                 {1, 0.66666666666666663, 0.83333333333333337},
                                 {3, 3.0, 1.0},
                                 {20, 20.0, 1.0}};
template <>
const Row table<Softsign>[8] = {{-12, -0.92307692307692313, 0.0059171597633136093},
                                {-5, -0.83333333333333337, 0.027777777777777776},
                                {-2.5, -0.7142857142857143, 0.081632653061224483},
                                {-0.25, -0.20000000000000001, 0.64000000000000001},
                                {0.0009765625, 0.00097560975609756097, 0.99804973230220106},
                                {1, 0.5, 0.25},
                                {3, 0.75, 0.0625},
                                {20, 0.95238095238095233, 0.0022675736961451248}};
template <>
const Row table<Elu>[8] = {{-2.5, -0.9179150013761012, 0.0820849986238988},
                           {-1, -0.63212055882855768, 0.36787944117144232},
                           {-0.25, -0.22119921692859513, 0.77880078307140487},
                           {-0.0009765625, -9.7608581802433777e-4, 0.99902391418197566},
                           {0, 0, 1},
                           {1e-30, 1e-30, 1},
                           {3, 3, 1},
                           {20, 20, 1}};
template <>
const Row table<Silu>[8] = {{-12, -7.3730095226576614e-5, -6.7585467613783386e-5},
                            {-5, -0.033464254621424278, -0.026547432429665919},
                            {-2.5, -0.18964545005310888, -0.099401111341526841},
                            {-0.25, -0.10945587477855047, 0.37628997842980231},
                            {0.0009765625, 4.8851966856015376e-4, 0.5004882811723898},
                            {1, 0.73105857863000488, 0.92767051187148673},
                            {3, 2.8577223804672997, 1.0881041060151696},
                            {20, 19.999999958776928, 1.0000000391619187}};
template <>
const Row table<Softplus>[8] = {{-12, 6.1441934777328054e-6, 6.1441746022147178e-6},
                                {-5, 0.0067153484891180686, 0.0066928509242848556},
                                {-2.5, 0.078889734292549623, 0.075858180021243551},
                                {-0.25, 0.57593941987884356, 0.4378234991142019},
                                {0.0009765625, 0.69363558101923012, 0.50024414060559745},
                                {1, 1.3132616875182228, 0.73105857863000488},
                                {3, 3.0485873515737421, 0.95257412682243322},
                                {20, 20.000000002061154, 0.99999999793884638}};
template <>
const Row table<Sine>[8] = {{-12, 0.53657291800043497, 0.8438539587324921},
                            {-5, 0.95892427466313847, 0.28366218546322626},
                            {-2.5, -0.59847214410395649, -0.80114361554693371},
                            {-0.25, -0.24740395925452293, 0.96891242171064478},
                            {0.0009765625, 9.765623447795783e-4, 0.99999952316287969},
                            {1, 0.84147098480789651, 0.54030230586813972},
                            {3, 0.14112000805986722, -0.98999249660044546},
                            {20, 0.91294525072762765, 0.40808206181339199}};

template <class Spec, class Scalar>
using Bound = typename Spec::template Bind<Scalar, 1>;

template <class Spec, class Scalar>
Scalar slope_at(Scalar v) {
  using Layer = Bound<Spec, Scalar>;
  if constexpr (slopes_from_input<Layer>) {
    return Layer::slope_from_input(v);
  } else {
    return Layer::slope(Layer::activate(v));
  }
}

/// A few roundings, and in the tails one of the exponent, which is v^2 / 2 at most.
template <class Scalar>
void close(Scalar value, double expected, double v) {
  const double tolerance = (16 + v * v) * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
  CHECK(std::abs(static_cast<double>(value) - expected) <= tolerance * std::abs(expected));
}

template <class Spec, class Scalar>
void check_table() {
  for (const Row& row : table<Spec>) {
    CAPTURE(row.v);
    close(Bound<Spec, Scalar>::activate(Scalar(row.v)), row.y, row.v);
    close(slope_at<Spec>(Scalar(row.v)), row.slope, row.v);
  }
}

/// Values of every size, both signs.
template <class Scalar>
std::array<Scalar, 32> some_values() {
  std::array<Scalar, 32> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double size = std::pow(10.0, static_cast<double>(i / 2) * 0.6 - 6.0);
    v[i] = static_cast<Scalar>(i % 2 == 0 ? size : -size);
  }
  v[30] = std::numeric_limits<Scalar>::max();
  v[31] = -std::numeric_limits<Scalar>::max();
  return v;
}

template <class Scalar>
bool same(Scalar a, Scalar b) {
  return a == b || (a != a && b != b);
}

template <class Spec, class Pack>
void check_pack() {
  using Scalar = typename Pack::Scalar;
  using Layer = Bound<Spec, Scalar>;
  static_assert(activates_pack<Layer, Pack> && scales_pack<Layer, Pack>);
  auto values = some_values<Scalar>();
  values[5] = std::numeric_limits<Scalar>::quiet_NaN();
  for (std::size_t i = 0; i + Pack::width <= values.size(); ++i) {
    std::array<Scalar, Pack::width> y{}, seen{}, dy{}, dx{};
    const Pack v = Pack::load(values.data() + i);
    const Pack activated = detail::Activate<Layer>{}(v);
    activated.store(y.data());
    for (std::size_t k = 0; k < y.size(); ++k) {
      CHECK(same(y[k], Layer::activate(values[i + k])));
      seen[k] = slopes_from_input<Layer> ? values[i + k] : y[k];
      dy[k] = static_cast<Scalar>(k) - Scalar(1.5);
    }
    detail::scaled_by_slope<Layer>(Pack::load(seen.data()), Pack::load(dy.data())).store(dx.data());
    for (std::size_t k = 0; k < y.size(); ++k) {
      const Scalar expected = detail::scaled_by_slope<Layer>(seen[k], dy[k]);
      CAPTURE(seen[k]);
      if (expected != expected) {
        CHECK((dx[k] != dx[k] || std::is_same_v<Spec, Relu>));  // ReLU: the slope of NaN is 0
      } else {
        CHECK(std::abs(dx[k] - expected) <= 4 * std::numeric_limits<Scalar>::epsilon() * std::abs(dy[k]));
      }
    }
  }
}

}  // namespace

TEST_CASE_TEMPLATE("smooth activations and their slopes against 40 digits", Spec, Gelu, Silu, Softplus, Sine, GeluTanh,
                   Mish, HardSwish, Softsign, Elu) {
  SUBCASE("float") { check_table<Spec, float>(); }
  SUBCASE("double") { check_table<Spec, double>(); }
}

TEST_CASE_TEMPLATE("slopes against central differences", Spec, Gelu, Silu, Softplus, Sine, Tanh, Elu, LeakyRelu,
                   GeluTanh, Mish, HardSwish, Softsign) {
  using Layer = Bound<Spec, double>;
  constexpr double step = 1e-5, tolerance = 1e-9;  // step^2 and rounding / step
  for (double v = -12; v <= 12; v += 0.37) {
    CAPTURE(v);
    const double expected = (Layer::activate(v + step) - Layer::activate(v - step)) / (2 * step);
    CHECK(std::abs(slope_at<Spec>(v) - expected) <= tolerance);
  }
}

TEST_CASE_TEMPLATE("packs give what scalars give, NaN and the largest numbers too", Pack, PINNQUAD_TEST_REGISTER_PACKS,
                   GenericPack<float, 4>, GenericPack<double, 4>, GenericPack<float, 1>) {
  check_pack<Gelu, Pack>();
  check_pack<Silu, Pack>();
  check_pack<Softplus, Pack>();
  check_pack<Sine, Pack>();
  check_pack<Tanh, Pack>();
  check_pack<Relu, Pack>();
  check_pack<Elu, Pack>();
  check_pack<LeakyRelu, Pack>();
  check_pack<GeluTanh, Pack>();
  check_pack<Mish, Pack>();
  check_pack<HardSwish, Pack>();
  check_pack<Softsign, Pack>();
}

TEST_CASE_TEMPLATE("NaN goes through, in value and slope; nothing overflows", Scalar, float, double) {
  const Scalar nan = std::numeric_limits<Scalar>::quiet_NaN();
  const auto check = [nan](auto spec) {
    using Spec = decltype(spec);
    CHECK(std::isnan(Bound<Spec, Scalar>::activate(nan)));
    CHECK(std::isnan(slope_at<Spec>(nan)));
    for (const Scalar v : some_values<Scalar>()) {
      CAPTURE(v);
      CHECK(std::isfinite(Bound<Spec, Scalar>::activate(v)));
      CHECK(std::isfinite(slope_at<Spec>(v)));
    }
  };
  check(Gelu{});
  check(Silu{});
  check(Softplus{});
  check(Sine{});
  check(Tanh{});
  check(Elu{});
  CHECK(std::isnan(Bound<LeakyRelu, Scalar>::activate(nan)));
  check(GeluTanh{});
  check(Mish{});
  check(HardSwish{});
  check(Softsign{});
  // far out they are the line they approach: 0 on the left, v on the right
  const Scalar far = std::numeric_limits<Scalar>::max() / 2, infinity = std::numeric_limits<Scalar>::infinity();
  const auto approaches_relu = [far](auto spec) {
    using Layer = Bound<decltype(spec), Scalar>;
    CHECK(Layer::activate(far) == far);
    CHECK(Layer::activate(-far) == Scalar(0));
    CHECK(slope_at<decltype(spec)>(far) == Scalar(1));
    CHECK(slope_at<decltype(spec)>(-far) == Scalar(0));
  };
  approaches_relu(Gelu{});
  approaches_relu(Silu{});
  approaches_relu(Softplus{});
  approaches_relu(GeluTanh{});
  approaches_relu(Mish{});
  approaches_relu(HardSwish{});
  CHECK(Bound<Elu, Scalar>::activate(-infinity) == Scalar(-1));
  CHECK(Bound<Softplus, Scalar>::activate(-infinity) == Scalar(0));
  CHECK(Bound<Softplus, Scalar>::activate(infinity) == infinity);
  CHECK(std::isnan(Bound<Sine, Scalar>::activate(infinity)));
}
