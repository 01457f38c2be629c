// SPDX-License-Identifier: MIT
// The flight stacks' controller over what it logged.
#include "model/replay_core.hpp"

namespace programs {

std::unique_ptr<CoreReplay> core_replay(const std::vector<pinnquad::BlockModel>& models,
                                        const pinnquad::Airframe<float>& airframe, const CoreReplayOptions& options) {
  bool of_motion_alone = true;
  for (const pinnquad::BlockModel& model : models) {
    of_motion_alone = of_motion_alone && CoreFeatures::fits(model);
    if (PastCoreFeatures::fits(model)) continue;
    throw std::invalid_argument(
        model.path() +
        ": a flight stack's core flies float models of the motion, present and past, and of "
        "the battery voltage (no look ahead, no other column, no altitude); this one is another");
  }
  if (of_motion_alone) {
    return std::make_unique<detail::CoreReplayOf<CoreFeatures, RunTimeTrust<CoreFeatures>>>(models, airframe, options);
  }
  return std::make_unique<detail::CoreReplayOf<PastCoreFeatures, void>>(models, airframe, options);
}

}  // namespace programs
