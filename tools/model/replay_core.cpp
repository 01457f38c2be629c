// SPDX-License-Identifier: MIT
// The flight stacks' controller over what it logged, of the models that a core may be compiled for: those that ask for
// motion alone.
#include "model/replay_core.hpp"

#include "pinnquad/features/motion_parts.hpp"

namespace programs {

namespace {

template <class FeatureSet>
bool has_features(const ReplayModel& model) {
  static_assert(std::is_same_v<typename FeatureSet::template Inputs<float>, pinnquad::MotionInputs<float>>);
  bool found = false;
  detail::each_schema_of<FeatureSet>(model, [&found](auto) { found = true; });
  return found;
}

}  // namespace

std::unique_ptr<CoreReplay> core_replay(const std::vector<ReplayModel>& models,
                                        const pinnquad::Airframe<float>& airframe, const CoreReplayOptions& options) {
  std::unique_ptr<CoreReplay> core;
  const auto take = [&](auto features) {
    using Features = decltype(features);
    if (!core && has_features<Features>(models.front())) {
      core = std::make_unique<detail::CoreReplayOf<Features>>(models, airframe, options);
    }
  };
  take(pinnquad::PaperFeatures{});
  take(pinnquad::InverseFeatures{});
  take(pinnquad::PhysicsFeatures{});
  if (!core) {
    throw std::invalid_argument(models.front().path +
                                ": a flight stack's core flies float models of motion alone (features of the paper, of "
                                "--recipe structured, of physics with velocity); this one is another");
  }
  return core;
}

}  // namespace programs
