// SPDX-License-Identifier: MIT
// CASE COLUMN_WITHOUT_UNIT: pinnquad: a column of WithColumns has no name or no unit
// CASE COLUMN_TWICE: pinnquad: a column of WithColumns has a name that is taken
// CASE NO_COLUMN: pinnquad: WithColumns needs a column
// CASE COLUMN_OUTSIDE_A_WINDOW: pinnquad: columns belong inside a window
// CASE WINDOW_OF_WINDOWS: pinnquad: a window of windows is one with more taps
// CASE NO_SUCH_COLUMN: pinnquad: these inputs have no such column
// CASE WINDOW_OF_NO_FEATURES: pinnquad: Windowed's first argument is not a feature set
// CASE EVEN_CENTRED_WINDOW: pinnquad: a window has one tap or more, a centred one an odd number
// CASE PART_OF_OTHER_INPUTS: pinnquad: the part of PartlyWindowed has the same inputs as its feature set
// CASE CENTRED_PART: pinnquad: a centred window looks ahead, and no loop can
// CASE JOINED_TWICE: pinnquad: feature sets that are Joined have a feature in common
// CASE JOINED_INPUTS: pinnquad: feature sets that are Joined have the same Inputs
// CASE COLUMN_NOT_CHOSEN: pinnquad: Chosen leaves out a column that its inputs hold
// CASE CENTRED_HISTORY: pinnquad: a centred window looks ahead, and no loop can
// CASE UNMEASURED_INPUT: pinnquad: this model asks for more than MotionInputs; NetworkInverse needs a second argument
// CASE MEASURING_IN_SECONDS: pinnquad: what measures for NetworkInverse is called .*; time is a std::uint64_t of microseconds
// CASE MEASURING_MAY_THROW: pinnquad: what measures for NetworkInverse is called with state, time and inputs, and must be noexcept
#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/features/chosen_features.hpp"

namespace {

using namespace pinnquad;

struct Current {
  static constexpr const char* name = "pack_current";
#if !defined(COLUMN_WITHOUT_UNIT)
  static constexpr const char* unit = "A";
#endif
};

#if defined(COLUMN_TWICE)
using Measured = WithColumns<WithColumns<PaperFeatures, Current>, Current>;
#elif defined(COLUMN_OUTSIDE_A_WINDOW)
using Measured = WithColumns<Windowed<PaperFeatures, 3, PeriodMicroseconds<20000>>, Current>;
#elif defined(NO_COLUMN)
using Measured = WithColumns<PaperFeatures>;
#else
using Measured = WithColumns<PaperFeatures, Current>;
#endif

#if defined(WINDOW_OF_NO_FEATURES)
using Past = Windowed<int, 3, PeriodMicroseconds<20000>>;
#elif defined(EVEN_CENTRED_WINDOW)
using Past = Windowed<Measured, 4, PeriodMicroseconds<20000>, Centred>;
#elif defined(WINDOW_OF_WINDOWS)
using Past = Windowed<Windowed<Measured, 2, PeriodMicroseconds<20000>>, 3, PeriodMicroseconds<20000>>;
#elif defined(CENTRED_HISTORY)
using Past = Windowed<Measured, 3, PeriodMicroseconds<20000>, Centred>;
#elif defined(PART_OF_OTHER_INPUTS)
using Past = PartlyWindowed<Measured, PaperFeaturesWithAltitude, 3, PeriodMicroseconds<20000>>;
#elif defined(CENTRED_PART)
using Past = PartlyWindowed<Measured, AccelerationFeatures, 3, PeriodMicroseconds<20000>, Centred>;
#elif defined(JOINED_TWICE)
using Past = Windowed<Joined<BodyRates, DownVector, BodyRates>, 3, PeriodMicroseconds<20000>>;
#elif defined(COLUMN_NOT_CHOSEN)
using Past = Windowed<Chosen<Measured, 3, 4, 5>, 3, PeriodMicroseconds<20000>>;
#elif defined(JOINED_INPUTS)
using Past = Windowed<Joined<BodyRates, PaperFeaturesWithAltitude>, 3, PeriodMicroseconds<20000>>;
#else
using Past = Windowed<Measured, 3, PeriodMicroseconds<20000>>;
#endif

/// Stands in for a model: as much of InverseDynamics as NetworkInverse asks.
struct Inverse {
  using Scalar = float;
  using Features = Past;
  struct Report {
    Status cause{Status::ok};
  };
  Status predict(const Past::Inputs<float>&, const PlaceAndTime<double>&, Commands<float>&, Report&) const noexcept {
    return Status::ok;
  }
};

#if defined(MEASURING_IN_SECONDS)
using Time = double;
#else
using Time = std::uint64_t;
#endif

struct Ammeter {
  void operator()(const State<double>&, Time, Measured::Inputs<float>& inputs) const
#if !defined(MEASURING_MAY_THROW)
      noexcept
#endif
  {
#if defined(NO_SUCH_COLUMN)
    inputs.column<BatteryVoltage>() = 3;
#else
    inputs.column<Current>() = 3;
#endif
  }
};

#if defined(UNMEASURED_INPUT)
using FeedForward = NetworkInverse<Inverse>;
#else
using FeedForward = NetworkInverse<Inverse, Ammeter>;
#endif

}  // namespace

int main() {
  FeedForward feed_forward{Inverse{}};
  Commands<double> commands{};
  return feed_forward(State<double>{}, Accelerations<double>{}, std::uint64_t(0), commands) == Status::ok ? 0 : 1;
}
