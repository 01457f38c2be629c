// SPDX-License-Identifier: MIT
#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/features/chosen_features.hpp"

using namespace pinnquad;

struct Current {
  static constexpr const char* name = "pack_current";
  static constexpr const char* unit = "A";
};
using Measured = WithColumns<PaperFeatures, Current>;
using Fifty = PeriodMicroseconds<20000>;

/// Stands in for a model: as much of InverseDynamics as NetworkInverse asks.
template <class FeatureSet>
struct Inverse {
  using Scalar = float;
  using Features = FeatureSet;
  struct Report {
    Status cause{Status::ok};
  };
  template <class Inputs>
  Status predict(const Inputs&, const PlaceAndTime<double>&, Commands<float>&, Report&) const noexcept {
    return Status::ok;
  }
};

template <class Column, class Time = std::uint64_t, bool IsNoexcept = true>
struct Meter {
  template <class Inputs>
  void operator()(const State<double>&, Time, Inputs& inputs) const noexcept(IsNoexcept) {
    inputs.template column<Column>() = 3;
  }
};

template <class Features, class... Measures>
Status fed_forward() {
  NetworkInverse<Inverse<Features>, Measures...> feed_forward{Inverse<Features>{}};
  Commands<double> commands{};
  return feed_forward(State<double>{}, Accelerations<double>{}, std::uint64_t(0), commands);
}
template <class Features>
constexpr int size = Features::size;

// SOUND
const auto status = fed_forward<Windowed<Measured, 3, Fifty>, Meter<Current>>();

// CASE COLUMN_WITHOUT_UNIT: pinnquad: a column of WithColumns has no name or no unit
struct Unitless {
  static constexpr const char* name = "pack_current";
};
constexpr int wrong = size<WithColumns<PaperFeatures, Unitless>>;
// CASE COLUMN_TWICE: pinnquad: a column of WithColumns has a name that is taken
constexpr int wrong = size<WithColumns<WithColumns<PaperFeatures, Current>, Current>>;
// CASE NO_COLUMN: pinnquad: WithColumns needs a column
constexpr int wrong = size<WithColumns<PaperFeatures>>;
// CASE COLUMN_OUTSIDE_A_WINDOW: pinnquad: columns belong inside a window
constexpr int wrong = size<WithColumns<Windowed<PaperFeatures, 3, Fifty>, Current>>;
// CASE WINDOW_OF_WINDOWS: pinnquad: a window of windows is one with more taps
constexpr int wrong = size<Windowed<Windowed<Measured, 2, Fifty>, 3, Fifty>>;
// CASE NO_SUCH_COLUMN: pinnquad: these inputs have no such column
const auto status = fed_forward<Windowed<Measured, 3, Fifty>, Meter<BatteryVoltage>>();
// CASE WINDOW_OF_NO_FEATURES: pinnquad: Windowed's first argument is not a feature set
constexpr int wrong = size<Windowed<int, 3, Fifty>>;
// CASE EVEN_CENTRED_WINDOW: pinnquad: a window has one tap or more, a centred one an odd number
constexpr int wrong = size<Windowed<Measured, 4, Fifty, Centred>>;
// CASE PART_OF_OTHER_INPUTS: pinnquad: the part of PartlyWindowed has the same inputs as its feature set
constexpr int wrong = size<PartlyWindowed<Measured, PaperFeaturesWithAltitude, 3, Fifty>>;
// CASE CENTRED_PART: pinnquad: a centred window looks ahead, and no loop can
const auto status = fed_forward<PartlyWindowed<Measured, AccelerationFeatures, 3, Fifty, Centred>, Meter<Current>>();
// CASE JOINED_TWICE: pinnquad: feature sets that are Joined have a feature in common
constexpr int wrong = size<Windowed<Joined<BodyRates, DownVector, BodyRates>, 3, Fifty>>;
// CASE JOINED_INPUTS: pinnquad: feature sets that are Joined have the same Inputs
constexpr int wrong = size<Windowed<Joined<BodyRates, PaperFeaturesWithAltitude>, 3, Fifty>>;
// CASE COLUMN_NOT_CHOSEN: pinnquad: Chosen leaves out a column that its inputs hold
constexpr int wrong = size<Windowed<Chosen<Measured, 3, 4, 5>, 3, Fifty>>;
// CASE CENTRED_HISTORY: pinnquad: a centred window looks ahead, and no loop can
const auto status = fed_forward<Windowed<Measured, 3, Fifty, Centred>, Meter<Current>>();
// CASE UNMEASURED_INPUT: pinnquad: this model asks for more than MotionInputs; NetworkInverse needs a second argument
const auto status = fed_forward<Windowed<Measured, 3, Fifty>>();
// CASE MEASURING_IN_SECONDS: pinnquad: what measures for NetworkInverse is called .*; time is a std::uint64_t of microseconds
const auto status = fed_forward<Windowed<Measured, 3, Fifty>, Meter<Current, double>>();
// CASE MEASURING_MAY_THROW: pinnquad: what measures for NetworkInverse is called with state, time and inputs, and must be noexcept
const auto status = fed_forward<Windowed<Measured, 3, Fifty>, Meter<Current, std::uint64_t, false>>();
