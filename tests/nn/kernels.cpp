// SPDX-License-Identifier: MIT
// Every kernel against plain loops in double: portable, packed and mini-batch, all packs, many sizes.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "pinnquad/nn/kernel/column_broadcast.hpp"
#include "pinnquad/nn/kernel/portable.hpp"
#include "pinnquad/nn/kernel/tile.hpp"
#include "pinnquad/nn/kernel/transpose.hpp"
#include "support/packs.hpp"
#include "support/random_network.hpp"
#include "support/tolerances.hpp"

using pinnquad::GenericPack;
using pinnquad::NativePack;
using pinnquad::padded;
using pinnquad::test::fill_uniform;
using pinnquad::test::rounding;

namespace {

/// Contents of padding before a kernel runs; it must not read them.
constexpr double canary = 1e30;

/// Rows x Columns of a matrix under test.
template <int Rows, int Columns>
struct Shape {
  static constexpr int rows = Rows;
  static constexpr int columns = Columns;
};

template <class... Shapes>
struct ShapeList {};

/// One to forty, on both sides of a pack's width, and the sizes of the paper's network: each shape is there for a
/// remainder of its own.
using Shapes = ShapeList<Shape<1, 1>, Shape<3, 2>, Shape<2, 40>, Shape<4, 25>, Shape<7, 3>, Shape<9, 5>, Shape<16, 4>,
                         Shape<25, 16>, Shape<33, 9>, Shape<40, 1>>;

/// More rows than one block of packs, more columns than one round of chains.
using LargeShapes = ShapeList<Shape<64, 64>, Shape<100, 37>, Shape<37, 100>, Shape<256, 256>>;

template <class Function, class... Each>
void for_each_shape(ShapeList<Each...>, const Function& function) {
  (function(Each{}), ...);
}

/// A sum of `terms` products of numbers in +-1: one rounding each, of a sum that stays below `terms`.
template <class Scalar>
double sum_tolerance(int terms) {
  return rounding<Scalar>(terms + 1) * std::sqrt(static_cast<double>(terms) + 1.0);
}

template <class Scalar, int Rows, int Columns>
struct Problem {
  std::array<Scalar, Rows * Columns> weight{};
  std::array<Scalar, Rows> bias{};
  std::array<Scalar, Columns> x{};

  explicit Problem(std::mt19937_64& engine) {
    fill_uniform(weight, engine);
    fill_uniform(bias, engine);
    fill_uniform(x, engine);
  }
  double expected(int row) const {
    double sum = static_cast<double>(bias[static_cast<std::size_t>(row)]);
    for (int column = 0; column < Columns; ++column) {
      sum += static_cast<double>(weight[static_cast<std::size_t>(row * Columns + column)]) *
             static_cast<double>(x[static_cast<std::size_t>(column)]);
    }
    return sum;
  }
};

}  // namespace

TEST_CASE_TEMPLATE("portable matrix-vector product", Scalar, float, double) {
  std::mt19937_64 engine(21);
  for_each_shape(Shapes{}, [&engine](auto shape) {
    constexpr int rows = decltype(shape)::rows, columns = decltype(shape)::columns;
    CAPTURE(rows);
    CAPTURE(columns);
    const Problem<Scalar, rows, columns> problem(engine);
    std::array<Scalar, rows + 1> y{};
    y[rows] = Scalar(canary);
    pinnquad::multiply_row_major<rows, columns>(problem.weight.data(), problem.bias.data(), problem.x.data(), y.data());
    for (int row = 0; row < rows; ++row) {
      CHECK(std::fabs(static_cast<double>(y[static_cast<std::size_t>(row)]) - problem.expected(row)) <=
            sum_tolerance<Scalar>(columns));
    }
    CHECK(y[rows] == Scalar(canary));  // writes its rows and nothing behind
  });
}

TEST_CASE_TEMPLATE("packed matrix-vector product: values, zero padding, nothing written behind it", Pack,
                   GenericPack<float, 4>, GenericPack<double, 4>, NativePack<float>, NativePack<double>) {
  using Scalar = typename Pack::Scalar;
  std::mt19937_64 engine(22);
  const auto check = [&engine](auto shape) {
    constexpr int rows = decltype(shape)::rows, columns = decltype(shape)::columns;
    constexpr int stride = padded<Pack>(rows);
    CAPTURE(rows);
    CAPTURE(columns);
    const Problem<Scalar, rows, columns> problem(engine);
    std::array<Scalar, pinnquad::detail::packed_size<Pack, rows, columns>> packed{};
    pinnquad::detail::pack_columns<Pack, rows, columns>(problem.weight.data(), problem.bias.data(), packed.data());
    std::array<Scalar, stride + 1> y{};
    y.fill(Scalar(canary));
    pinnquad::detail::multiply_packed<Pack, rows, columns>(packed.data(), problem.x.data(), y.data(),
                                                           [](Pack v) { return v; });
    for (int row = 0; row < stride; ++row) {
      const double value = static_cast<double>(y[static_cast<std::size_t>(row)]);
      if (row < rows) {
        CHECK(std::fabs(value - problem.expected(row)) <= sum_tolerance<Scalar>(columns));
      } else {
        CHECK(value == 0.0);
      }
    }
    CHECK(y[stride] == Scalar(canary));
  };
  for_each_shape(Shapes{}, check);
  if constexpr (std::is_same_v<Pack, NativePack<float>>) for_each_shape(LargeShapes{}, check);
}

TEST_CASE_TEMPLATE("mini-batch products: values, and padding that never leaks", Pack, GenericPack<float, 4>,
                   GenericPack<double, 4>, NativePack<float>, NativePack<double>) {
  using Scalar = typename Pack::Scalar;
  std::mt19937_64 engine(23);
  const auto at = [](auto& values, int stride, int row, int column) -> Scalar& {
    return values[static_cast<std::size_t>(row * stride + column)];
  };
  const auto size = [](int count, int stride) { return static_cast<std::size_t>(count * stride); };
  for_each_shape(Shapes{}, [&](auto shape) {
    constexpr int rows = decltype(shape)::rows, depth = decltype(shape)::columns;
    CAPTURE(rows);
    CAPTURE(depth);
    // W: rows x depth, X: depth x lanes, Y: rows x lanes; padding of W holds what would show if it were read
    constexpr int stride = padded<Pack>(depth + 1), lanes = 2 * Pack::width;
    std::vector<Scalar> w(size(rows, stride), Scalar(canary)), x(size(depth, lanes)), y(size(rows, lanes) + 1);
    std::vector<Scalar> start(size(rows, 1));
    fill_uniform(x, engine);
    fill_uniform(start, engine);
    for (int row = 0; row < rows; ++row) {
      for (int k = 0; k < depth; ++k) at(w, stride, row, k) = static_cast<Scalar>(pinnquad::uniform(engine, -1, 1));
    }
    y.back() = Scalar(canary);
    pinnquad::detail::multiply_lanes<Pack, 2, rows, stride, 1>(
        w.data(), x.data(), lanes, depth, [&](int row) { return Pack::broadcast(start[size(row, 1)]); },
        [&](int row, int vector, Pack sum) { return sum + Pack::broadcast(Scalar(10 * row + 1000 * vector)); },
        y.data(), lanes);
    for (int row = 0; row < rows; ++row) {
      for (int lane = 0; lane < lanes; ++lane) {
        double sum = static_cast<double>(start[size(row, 1)]);
        for (int k = 0; k < depth; ++k) {
          sum += static_cast<double>(at(w, stride, row, k)) * static_cast<double>(at(x, lanes, k, lane));
        }
        sum += 10 * row + 1000 * (lane / Pack::width);
        CHECK(std::fabs(static_cast<double>(at(y, lanes, row, lane)) - sum) <=
              sum_tolerance<Scalar>(depth) + rounding<Scalar>(1) * sum);
      }
    }
    CHECK(y.back() == Scalar(canary));

    // W^T Y, from the same W
    std::vector<Scalar> product(size(depth, lanes) + 1, Scalar(canary));
    fill_uniform(y, engine);
    pinnquad::detail::multiply_lanes<Pack, 2, depth, 1, stride>(
        w.data(), y.data(), lanes, rows, [](int) { return Pack::broadcast(Scalar(0)); },
        [](int, int, Pack sum) { return sum; }, product.data(), lanes);
    for (int k = 0; k < depth; ++k) {
      for (int lane = 0; lane < lanes; ++lane) {
        double sum = 0.0;
        for (int row = 0; row < rows; ++row) {
          sum += static_cast<double>(at(w, stride, row, k)) * static_cast<double>(at(y, lanes, row, lane));
        }
        CHECK(std::fabs(static_cast<double>(at(product, lanes, k, lane)) - sum) <= sum_tolerance<Scalar>(rows));
      }
    }
    CHECK(product.back() == Scalar(canary));

    // Y Z: rows x padded depth, over fewer samples than Y's rows hold
    for (const int samples : {1, 2, 3, lanes - 1, lanes}) {
      CAPTURE(samples);
      std::vector<Scalar> z(size(samples, stride)), c(size(rows, stride) + 1, Scalar(canary));
      fill_uniform(z, engine);
      pinnquad::detail::multiply_matrices<Pack, rows, lanes, stride>(y.data(), z.data(), samples, c.data());
      for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < stride; ++column) {
          double sum = 0.0;
          for (int i = 0; i < samples; ++i) {
            sum += static_cast<double>(at(y, lanes, row, i)) * static_cast<double>(at(z, stride, i, column));
          }
          CHECK(std::fabs(static_cast<double>(at(c, stride, row, column)) - sum) <= sum_tolerance<Scalar>(samples));
        }
      }
      CHECK(c.back() == Scalar(canary));
    }
  });
}

TEST_CASE_TEMPLATE("a transposed matrix of any size, and nothing else written", Pack, PINNQUAD_TEST_REGISTER_PACKS,
                   GenericPack<float, 4>, GenericPack<double, 3>) {
  using Scalar = typename Pack::Scalar;
  for (const int rows : {1, 3, 4, 7, 8, 15, 16, 17, 25, 40}) {
    for (const int columns : {1, 3, 4, 5, 16, 25}) {
      CAPTURE(rows);
      CAPTURE(columns);
      const int from_stride = columns + 3, to_stride = rows + 2;
      std::vector<Scalar> from(static_cast<std::size_t>((rows - 1) * from_stride + columns));
      for (std::size_t i = 0; i < from.size(); ++i) from[i] = Scalar(i + 1);
      std::vector<Scalar> to(static_cast<std::size_t>(columns * to_stride), Scalar(canary));
      pinnquad::detail::transpose<Pack>(from.data(), from_stride, rows, columns, to.data(), to_stride);
      for (int column = 0; column < columns; ++column) {
        for (int row = 0; row < to_stride; ++row) {
          CHECK(to[static_cast<std::size_t>(column * to_stride + row)] ==
                (row < rows ? from[static_cast<std::size_t>(row * from_stride + column)] : Scalar(canary)));
        }
      }
    }
  }
}

TEST_CASE_TEMPLATE("every pack does what a scalar does, lane by lane", Pack, PINNQUAD_TEST_REGISTER_PACKS,
                   PINNQUAD_TEST_DOUBLE_PACKS, GenericPack<float, 4>, GenericPack<double, 4>, GenericPack<float, 1>) {
  using Scalar = typename Pack::Scalar;
  const Scalar infinity = std::numeric_limits<Scalar>::infinity();
  const Scalar nan = std::numeric_limits<Scalar>::quiet_NaN();
  const Scalar specials[] = {Scalar(0), Scalar(-0.0), Scalar(1.5),   Scalar(-2.25), infinity,
                             -infinity, nan,          Scalar(1e-30), Scalar(-1e-30)};
  const auto same = [](Scalar a, Scalar b) { return a == b || (a != a && b != b); };
  for (const Scalar special : specials) {
    for (int lane = 0; lane < Pack::width; ++lane) {
      CAPTURE(special);
      CAPTURE(lane);
      // distinct values around the special one: a lane that moved would show
      std::array<Scalar, Pack::width> a{}, b{}, c{}, r{};
      for (std::size_t i = 0; i < a.size(); ++i) {
        a[i] = Scalar(0.5) * static_cast<Scalar>(i) - Scalar(1.75);
        b[i] = static_cast<Scalar>(i) + Scalar(1.25);
        c[i] = Scalar(3) - static_cast<Scalar>(i);
      }
      a[static_cast<std::size_t>(lane)] = special;
      const Pack pa = Pack::load(a.data()), pb = Pack::load(b.data()), pc = Pack::load(c.data());
      const auto check = [&](const Pack& pack, const auto& expected) {
        pack.store(r.data());
        for (std::size_t i = 0; i < r.size(); ++i) CHECK(same(r[i], expected(i)));
      };
      check(pa + pb, [&](std::size_t i) { return a[i] + b[i]; });
      check(pa - pb, [&](std::size_t i) { return a[i] - b[i]; });
      check(pa * pb, [&](std::size_t i) { return a[i] * b[i]; });
      check(pa / pb, [&](std::size_t i) { return a[i] / b[i]; });
      check(Pack::broadcast(special), [&](std::size_t) { return special; });
      check(Pack::square_root(pb), [&](std::size_t i) { return std::sqrt(b[i]); });
      check(pinnquad::detail::each_lane(pa, [](Scalar v) { return v + Scalar(1); }),
            [&](std::size_t i) { return a[i] + Scalar(1); });
      check(Pack::positive_part(pa), [&](std::size_t i) { return a[i] < Scalar(0) ? Scalar(0) : a[i]; });
      check(Pack::where_positive(pa, pb), [&](std::size_t i) { return a[i] > Scalar(0) ? b[i] : Scalar(0); });
      // small integers and quarters: exact with one rounding or two
      if (std::fabs(special) < infinity && std::fabs(special) > Scalar(1e-20)) {
        check(Pack::multiply_add(pa, pb, pc), [&](std::size_t i) { return a[i] * b[i] + c[i]; });
      }
    }
  }
}

TEST_CASE_TEMPLATE("portable: each output has the bits of one plain chain, held inputs or not, odd rows or not", Scalar,
                   float, double) {
  // narrower than what is held, as wide, one wider, two parts, three parts that differ in width
  using Wide = ShapeList<Shape<1, 1>, Shape<2, 7>, Shape<3, 25>, Shape<25, 25>, Shape<4, 26>, Shape<5, 50>,
                         Shape<3, 64>, Shape<2, 76>>;
  std::mt19937_64 engine(24);
  for_each_shape(Wide{}, [&engine](auto shape) {
    constexpr int rows = decltype(shape)::rows, columns = decltype(shape)::columns;
    CAPTURE(rows);
    CAPTURE(columns);
    const Problem<Scalar, rows, columns> problem(engine);
    std::array<Scalar, rows> y{}, activated{}, without_bias{}, chain{}, chain_without_bias{};
    const Scalar* const weight = problem.weight.data();
    pinnquad::multiply_row_major<rows, columns>(weight, problem.bias.data(), problem.x.data(), y.data());
    pinnquad::multiply_row_major<rows, columns>(weight, problem.bias.data(), problem.x.data(), activated.data(),
                                                [](Scalar v) { return v + Scalar(1); });
    pinnquad::multiply_row_major<rows, columns>(weight, pinnquad::detail::NoBias<Scalar>{}, problem.x.data(),
                                                without_bias.data());
    for (std::size_t row = 0; row < rows; ++row) {
      chain[row] = problem.bias[row];
      for (std::size_t column = 0; column < columns; ++column) {
        const Scalar w = weight[row * columns + column];
        chain[row] = pinnquad::multiply_add(w, problem.x[column], chain[row]);
        chain_without_bias[row] = pinnquad::multiply_add(w, problem.x[column], chain_without_bias[row]);
      }
      CHECK(activated[row] == chain[row] + Scalar(1));
    }
    CHECK(y == chain);
    CHECK(without_bias == chain_without_bias);
  });
}
