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
#include "support/described_model.hpp"

using namespace pinnquad;
using pinnquad::test::BlockBytes;
using pinnquad::test::DescribedModel;
using pinnquad::test::DoubleModel;

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
  using Model = DescribedModel;
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

TEST_CASE_TEMPLATE("a view answers as the header does, to its bits where the weights were packed", Model,
                   DescribedModel, DoubleModel) {
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
  BlockBytes block(model_block<DescribedModel>());
  using Layout = ModelBlockLayout<DescribedModel>;
  block.set_scalar(Layout::envelope_upper, 0.5f);  // narrower than the header's
  for (std::size_t row = 0; row < DescribedModel::golden_features.size(); ++row) {
    block.set_scalar(Layout::golden_features + row * Layout::inputs, 0.25f);  // inside it
  }
  block.seal();
  const InverseDynamics<ModelView<DescribedModel>> viewed(view_of<DescribedModel>(block));
  ModelView<DescribedModel>::Packed packed;
  const InverseDynamics<ModelView<DescribedModel>> fast(packed_view_of<DescribedModel>(block, packed));
  const auto refused = [](const auto& inverse, float v_dot, Status expected) {
    MotionInputs<float> inputs;
    inputs.linear_acceleration_m_s2[0] = v_dot;
    Commands<float> commands{9, 9, 9, 9};
    const Status status = inverse.predict(inputs, commands);
    return status == expected && (status == Status::ok) == (commands[0] != 9.0f);
  };
  CHECK(refused(InverseDynamics<DescribedModel>{}, 1.0f, Status::ok));
  for (const auto& [v_dot, expected] : {std::pair{0.4f, Status::ok}, std::pair{1.0f, Status::outside_envelope},
                                        std::pair{std::numeric_limits<float>::quiet_NaN(), Status::not_finite}}) {
    CHECK(refused(viewed, v_dot, expected));
    CHECK(refused(fast, v_dot, expected));
  }
}

TEST_CASE("a wrong weight under a right checksum fails the self test") {
  using Layout = ModelBlockLayout<DescribedModel>;
  for (const std::size_t weight : {0u, 77u, 131u, 150u, 171u}) {
    BlockBytes block(model_block<DescribedModel>());
    const std::size_t at = Layout::parameters(6) + weight;
    block.set_scalar(at, block.scalar<float>(at) + 0.05f);
    block.seal();
    CHECK(self_test(InverseDynamics<ModelView<DescribedModel>>(view_of<DescribedModel>(block))) ==
          Status::self_test_failed);
    ModelView<DescribedModel>::Packed packed;
    CHECK(self_test(InverseDynamics<ModelView<DescribedModel>>(packed_view_of<DescribedModel>(block, packed))) ==
          Status::self_test_failed);
  }
}

TEST_CASE("finite weights that overflow are told from sound ones") {
  using Layout = ModelBlockLayout<DescribedModel>;
  BlockBytes block(model_block<DescribedModel>());
  for (std::size_t i = 0; i < Layout::parameter_count; ++i) block.set_scalar(Layout::parameters(6) + i, 3e38f);
  block.seal();
  const InverseDynamics<ModelView<DescribedModel>> viewed(view_of<DescribedModel>(block));
  Commands<float> commands{9, 9, 9, 9};
  CHECK(viewed.predict({}, commands) == Status::output_not_finite);
  CHECK(commands[0] == 9.0f);
  CHECK(self_test(viewed) == Status::self_test_failed);
}

TEST_CASE("a view of no block refuses to fly") {
  const InverseDynamics<ModelView<DescribedModel>> viewed{ModelView<DescribedModel>{}};
  Commands<float> commands{};
  CHECK(viewed.predict({}, commands) == Status::outside_envelope);
  CHECK(self_test(viewed) == Status::self_test_failed);
}

TEST_CASE("a view is opened anew while it is a copy that flies") {
  const BlockBytes first(model_block<DescribedModel>());
  BlockBytes second(model_block<DescribedModel>());
  const std::size_t last_bias = ModelBlockLayout<DescribedModel>::parameters(6) + 171;
  second.set_scalar(last_bias, second.scalar<float>(last_bias) + 1.0f);
  second.seal();
  ModelView<DescribedModel> view = view_of<DescribedModel>(first);
  const InverseDynamics<ModelView<DescribedModel>> flying(view);
  REQUIRE(ModelView<DescribedModel>::open(second.data(), second.size(), view) == Status::ok);
  CHECK(self_test(flying) == Status::ok);
  CHECK(self_test(InverseDynamics<ModelView<DescribedModel>>(view)) == Status::self_test_failed);
}
