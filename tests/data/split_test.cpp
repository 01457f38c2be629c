// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <pinnquad/data/split.hpp>
#include <stdexcept>
#include <vector>

using pinnquad::split_contiguous;
using pinnquad::detail::Split;

TEST_CASE("the paper's flight splits into 9000, 3000 and 3000 rows") {
  const auto split = split_contiguous(15000);
  CHECK(split.train.begin == 0);
  CHECK(split.train.size() == 9000);
  CHECK(split.validation.size() == 3000);
  CHECK(split.test.size() == 3000);
}

TEST_CASE("blocks adjoin, cover every row once, and miss their share by at most one row") {
  const std::vector<Split<double>> all_shares = {{0.6, 0.2, 0.2},
                                                 {0.7, 0.2, 0.1},
                                                 {0.2, 0.4, 0.4},
                                                 {0.2, 0, 0.8},
                                                 {0.8, 0.2, 0},
                                                 {1, 0, 0},
                                                 {1.0 / 3, 1.0 / 3, 1.0 / 3}};
  for (const Split<double>& shares : all_shares) {
    for (std::size_t rows = 20; rows < 300; ++rows) {
      CAPTURE(rows);
      CAPTURE(shares.train);
      const auto split = split_contiguous(rows, shares);
      CHECK(split.train.begin == 0);
      CHECK(split.train.end == split.validation.begin);
      CHECK(split.validation.end == split.test.begin);
      CHECK(split.test.end == rows);
      const auto miss = [rows](const pinnquad::IndexRange& block, double share) {
        return std::abs(static_cast<double>(block.size()) - share * static_cast<double>(rows));
      };
      const double last_border = (shares.train + shares.validation) * static_cast<double>(rows);
      CHECK(miss(split.train, shares.train) <= 0.5 + 1e-9);  // one rounded border
      CHECK(std::abs(static_cast<double>(split.validation.end) - last_border) <= 0.5 + 1e-9);
      CHECK(miss(split.validation, shares.validation) <= 1 + 1e-9);
      CHECK(miss(split.test, shares.test) <= 1 + 1e-9);
      CHECK(split.validation.empty() == (shares.validation == 0));
      CHECK(split.test.empty() == (shares.test == 0));
    }
  }
}

TEST_CASE("halves round up") {
  const auto split = split_contiguous(9, {0.5, 0.25, 0.25});  // borders 4.5 and 6.75
  CHECK(split.train.end == 5);
  CHECK(split.validation.end == 7);
}

TEST_CASE("without a share of the test block the validation block ends with the rows, whatever the shares' rounding") {
  constexpr std::size_t rows = 4000000000;
  const auto split = split_contiguous(rows, {0.5, 0.5 - 9e-10, 0});
  CHECK(split.validation.end == rows);
  CHECK(split.test.size() == 0);
}

TEST_CASE("every block with a share needs two rows") {
  CHECK_THROWS_WITH_AS(split_contiguous(0),
                       "split: expected at least 2 rows for the training block, found 0 of 0 rows in all",
                       std::invalid_argument);
  CHECK_THROWS_WITH_AS(split_contiguous(5),
                       "split: expected at least 2 rows for the validation block, found 1 of 5 rows in all",
                       std::invalid_argument);
  for (std::size_t rows = 10; rows < 50; ++rows) CHECK_NOTHROW(split_contiguous(rows));
  CHECK_NOTHROW(split_contiguous(2, {1, 0, 0}));
}

TEST_CASE("shares outside 0..1, NaN, or with another sum are refused") {
  CHECK_THROWS_WITH_AS(split_contiguous(100, {0.6, 0.2, 0.3}),
                       "split: expected three shares in 0..1 with the sum 1, found 0.600000, 0.200000, 0.300000",
                       std::invalid_argument);
  CHECK_THROWS_AS(split_contiguous(100, {1.2, -0.2, 0}), std::invalid_argument);
  CHECK_THROWS_AS(split_contiguous(100, {0.6, 0.6, -0.2}), std::invalid_argument);
  CHECK_THROWS_AS(split_contiguous(100, {0.5, 0.2, std::numeric_limits<double>::quiet_NaN()}), std::invalid_argument);
}
