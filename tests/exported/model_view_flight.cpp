// SPDX-License-Identifier: MIT
// A model from a block flies as the exported header does: the same answers, refusals, self test.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/inference/self_test.hpp"
#include "support/block_bytes.hpp"
#include "support/small_model_variants.hpp"

using namespace pinnquad;
using pinnquad::test::BlockBytes;
using pinnquad::test::DoubleModel;
using pinnquad::test::SmallModel;

namespace {

template <class Shape>
ModelView<Shape> view_of(const BlockBytes& block) {
  ModelView<Shape> view;
  REQUIRE(ModelView<Shape>::open(block.data(), block.size(), view) == Status::ok);
  return view;
}

template <class Shape>
ModelView<Shape> packed_view_of(const BlockBytes& block, typename ModelView<Shape>::Packed& packed) {
  ModelView<Shape> view;
  REQUIRE(ModelView<Shape>::open(block.data(), block.size(), view, packed) == Status::ok);
  return view;
}

/// The commands of a model for features between the golden ones, or nothing.
template <class Inverse>
std::size_t agreeing(const Inverse& inverse, double tolerance) {
  using Model = SmallModel;
  using Scalar = typename Inverse::Scalar;
  const auto flash = [] {
    if constexpr (std::is_same_v<Scalar, double>) {
      return InverseDynamics<DoubleModel>{};
    } else {
      return InverseDynamics<Model>{};
    }
  }();
  std::size_t agree = 0;
  for (std::size_t i = 0; i < Model::golden_features.size(); ++i) {
    for (std::size_t k = 0; k < Model::golden_features.size(); ++k) {
      Scalar x[16];
      for (std::size_t n = 0; n < 16; ++n) {
        x[n] = Scalar(0.5F * (Model::golden_features[i][n] + Model::golden_features[k][n]));
      }
      Commands<Scalar> expected{}, commands{};
      REQUIRE(flash.predict_features(x, expected) == Status::ok);
      REQUIRE(inverse.predict_features(x, commands) == Status::ok);
      bool same = true;
      for (std::size_t n = 0; n < 4; ++n) same &= double(std::abs(commands[n] - expected[n])) <= tolerance;
      agree += same;
    }
  }
  return agree;
}

}  // namespace

TEST_CASE_TEMPLATE("a view answers as the header does, to its bits where the weights were packed", Model, SmallModel,
                   DoubleModel) {
  const BlockBytes block(model_block<Model>());
  const InverseDynamics<ModelView<Model>> viewed(view_of<Model>(block));
  typename ModelView<Model>::Packed packed;
  const InverseDynamics<ModelView<Model>> fast(packed_view_of<Model>(block, packed));
  CHECK(agreeing(viewed, golden_tolerance) == 36);
  CHECK(agreeing(fast, 0) == 36);  // the same kernel over the same packed weights
  CHECK(self_test(viewed) == Status::ok);
  CHECK(self_test(fast) == Status::ok);
}

TEST_CASE("bad inputs are refused by the block's envelope, commands untouched") {
  BlockBytes block(model_block<SmallModel>());
  using Layout = ModelBlockLayout<SmallModel>;
  block.set_scalar(Layout::envelope_upper, 0.5f);  // narrower than the header's
  for (std::size_t row = 0; row < SmallModel::golden_features.size(); ++row) {
    block.set_scalar(Layout::golden_features + row * Layout::inputs, 0.25f);  // inside it
  }
  block.seal();
  const InverseDynamics<ModelView<SmallModel>> viewed(view_of<SmallModel>(block));
  ModelView<SmallModel>::Packed packed;
  const InverseDynamics<ModelView<SmallModel>> fast(packed_view_of<SmallModel>(block, packed));
  const auto refused = [](const auto& inverse, float v_dot, Status expected) {
    MotionInputs<float> inputs;
    inputs.linear_acceleration_m_s2[0] = v_dot;
    Commands<float> commands{9, 9, 9, 9};
    const Status status = inverse.predict(inputs, commands);
    return status == expected && (status == Status::ok) == (commands[0] != 9.0f);
  };
  CHECK(refused(InverseDynamics<SmallModel>{}, 1.0f, Status::ok));
  for (const auto& [v_dot, expected] : {std::pair{0.4f, Status::ok}, std::pair{1.0f, Status::outside_envelope},
                                        std::pair{std::numeric_limits<float>::quiet_NaN(), Status::not_finite}}) {
    CHECK(refused(viewed, v_dot, expected));
    CHECK(refused(fast, v_dot, expected));
  }
}

TEST_CASE("a view is opened anew while it is a copy that flies") {
  const BlockBytes first(model_block<SmallModel>());
  BlockBytes second(model_block<SmallModel>());
  const std::size_t last_bias = ModelBlockLayout<SmallModel>::parameters(6) + 171;
  second.set_scalar(last_bias, second.scalar<float>(last_bias) + 1.0f);
  second.seal();
  ModelView<SmallModel> view = view_of<SmallModel>(first);
  const InverseDynamics<ModelView<SmallModel>> flying(view);
  REQUIRE(ModelView<SmallModel>::open(second.data(), second.size(), view) == Status::ok);
  CHECK(self_test(flying) == Status::ok);
  CHECK(self_test(InverseDynamics<ModelView<SmallModel>>(view)) == Status::self_test_failed);
}
