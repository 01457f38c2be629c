// SPDX-License-Identifier: MIT
// The flight stacks' controller over what it logged.
#include "model/replay_core.hpp"

namespace programs {

std::unique_ptr<CoreReplay> core_replay(const std::vector<pinnquad::BlockModel>& models,
                                        const pinnquad::Airframe<float>& airframe, const CoreReplayOptions& options) {
  for (const pinnquad::BlockModel& model : models) {
    if (CoreFeatures::fits(model)) continue;
    throw std::invalid_argument(model.path() +
                                ": a flight stack's core flies float models of the present motion alone (no window, no "
                                "column, no altitude); this one is another");
  }
  return std::make_unique<detail::CoreReplayOf>(models, airframe, options);
}

}  // namespace programs
