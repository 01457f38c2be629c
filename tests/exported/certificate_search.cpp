// SPDX-License-Identifier: MIT
// A search for what refutes a proof: random feature sets (any parts, chosen places, windows, columns), structures and
// weights. Where a block's model is proven, no signed sum may fall over a larger acceleration of the present, nor
// over one that is held, nor rise by less than is proven; nor may the sum of all rise by less with thrust, whatever the
// centre of gravity. The motions are moved, not the features: the search knows no feature by its name. A longer one, in
// seconds to minutes:
//   PINNQUAD_SEARCHED_COMPOSITIONS=600 PINNQUAD_SEARCHED_PAIRS=20000 test_exported -tc='*refutes a proof*'
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/outputs/rigid_body_base.hpp"
#include "support/block_bytes.hpp"
#include "support/random_states.hpp"

using namespace pinnquad;
using pinnquad::test::RandomStates;

namespace {

int from_environment(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

/// A feature at a tap; the present is tap 0.
struct Entry {
  std::string name, unit;
  int tap = 0;
};

/// How a column moves with the angular acceleration of its tap: by `share` of that about `axis`.
struct OwnColumn {
  const char *name, *unit;
  bool is_said;  ///< to be a column; else a feature of somebody's own, worked out from the motion
  int axis;
  double share;
};
constexpr OwnColumn own_columns[] = {{"battery_voltage", "V", true, 0, 0},  {"load", "N", true, 0, 0},
                                     {"wind_x", "m/s", true, 0, 0},         {"gyro_slope", "rad/s^2", true, 0, 1},
                                     {"turning", "deg/s/s", true, 1, 57.3}, {"torque_z", "N m", true, 2, 0.03},
                                     {"wdot_filtered", "1", true, 1, 0.5},  {"effort", "1", false, 2, 0.2},
                                     {"own_speed", "m/s", false, 0, 0}};

/// Features in turn, and where three in a row begin.
struct Composition {
  std::vector<Entry> entries;
  std::vector<int> threes;  ///< of the angular acceleration of a tap, in order
  int taps = 1;
  bool causal = true;
  double period_s = 0.02;
  bool begins_as_physics = false;  ///< specific force, angular acceleration, body rates

  int size() const { return int(entries.size()); }
  std::string text(int i) const {
    const Entry& entry = entries[std::size_t(i)];
    if (entry.tap == 0) return entry.name;
    const int periods = causal ? Causal::offset(taps, entry.tap - 1) : Centred::offset(taps, entry.tap - 1);
    return entry.name + (periods < 0 ? "[-" : "[+") + std::to_string(std::abs(periods)) + "]";
  }
};

class Composer {
 public:
  explicit Composer(std::mt19937_64& engine) : engine_(engine) {}

  Composition compose() {
    Composition all;
    all.taps = likely(0.2) ? 1 : 2 + below(4);
    all.causal = all.taps % 2 == 0 || likely(0.5);
    all.period_s = 0.01 * (1 + below(5));
    all.begins_as_physics = likely(0.2);
    add(all, part(all.begins_as_physics, 0.9), 0);
    // of each other tap the same part, as of a window, or any
    const std::vector<std::string> other = part(false, 0.4);
    for (int tap = 1; tap < all.taps; ++tap) add(all, likely(0.7) ? other : part(false, 0.4), tap);
    for (int i = 0; i + 2 < all.size(); ++i) {
      const auto is_axis = [&](int k) {
        const Entry& entry = all.entries[std::size_t(i + k)];
        return entry.name == NamedFeatures::names[std::size_t(3 + k)] && entry.tap == all.entries[std::size_t(i)].tap;
      };
      if (is_axis(0) && is_axis(1) && is_axis(2)) all.threes.push_back(i);
    }
    return all;
  }

  bool likely(double share) { return uniform(engine_, 0, 1) < share; }
  int below(int count) { return int(engine_() % std::uint64_t(count)); }

 private:
  /// Places in any order, columns, a lone angular acceleration at times; `turning`: how likely it has all three in
  /// turn, behind the first nine of PhysicsFeatures where it begins as these do.
  std::vector<std::string> part(bool begins_as_physics, double turning) {
    std::vector<std::string> all, first;
    for (int left = 1 + below(8); left > 0; --left) {
      const auto any = std::size_t(below(NamedFeatures::size));
      const auto column = std::size_t(below(likely(0.6) ? 3 : int(std::size(own_columns))));
      const bool turns = any >= 3 && any < 6;
      all.emplace_back(likely(0.8) && (!turns || likely(0.3)) ? NamedFeatures::names[any] : own_columns[column].name);
    }
    if (likely(0.1)) all.emplace_back("altitude");
    const std::vector<std::string> threes(NamedFeatures::names.begin() + 3, NamedFeatures::names.begin() + 6);
    if (begins_as_physics) {
      first.assign(PhysicsFeatures::names.begin(), PhysicsFeatures::names.begin() + 9);
    } else if (likely(turning)) {
      first = threes;
    }
    const auto place = begins_as_physics ? 0 : below(int(all.size()) + 1);
    all.insert(all.begin() + place, first.begin(), first.end());
    std::vector<std::string> once;
    for (auto name = all.begin(); name != all.end(); ++name) {  // each once, those in turn where they are
      const auto at = int(name - all.begin());
      const bool in_turn = at >= place && at < place + int(first.size());
      const bool elsewhere = std::find(first.begin(), first.end(), *name) != first.end() ||
                             std::find(once.begin(), once.end(), *name) != once.end();
      if (in_turn || !elsewhere) once.push_back(*name);
    }
    return once;
  }
  static std::string unit_of(const std::string& name) {
    for (std::size_t i = 0; i < NamedFeatures::names.size(); ++i) {
      if (name == NamedFeatures::names[i]) return NamedFeatures::units[i];
    }
    for (const OwnColumn& column : own_columns) {
      if (name == column.name) return column.unit;
    }
    return "m";
  }
  static void add(Composition& all, const std::vector<std::string>& names, int tap) {
    for (const std::string& name : names) all.entries.push_back({name, unit_of(name), tap});
  }

  std::mt19937_64& engine_;
};

/// A model of a composition: which structure, how large its weights are.
class Maker {
 public:
  Maker(std::mt19937_64& engine, const Composition& features)
      : engine_(engine), composer_(engine), features_(features) {}

  std::vector<unsigned char> block() {
    model_.name = "Searched";
    model_.loss = model_.training_data = "none";
    take_features();
    take_answer();
    const bool on_base = axis_commands_ && features_.begins_as_physics && composer_.likely(0.5);
    on_base ? take_outputs<SignedSumsOn<RigidBodyBase>>()
            : (axis_commands_ ? take_outputs<AxisCommandOutputs>() : take_outputs<CommandOutputs>());
    model_.golden_features.push_back(model_.input_mean);
    model_.golden_commands.push_back({});
    test::BlockBytes first(detail::block_of(model_));
    first.seal();
    const auto read = std::make_unique<RunTimeModel<double>>();
    const Status status = RunTimeModel<double>::open(first.data(), first.size(), *read);
    INFO("expected " << (read->fault().expected == nullptr ? "" : read->fault().expected));
    INFO(model_.answer);
    REQUIRE(status == Status::ok);
    std::vector<double> work(read->workspace());
    read->commands(model_.input_mean.data(), model_.golden_commands[0].data(), work.data());
    return detail::block_beside_header(model_);
  }

 private:
  double draw(double lower, double upper) { return uniform(engine_, lower, upper); }

  void take_features() {
    std::vector<std::string> said;
    for (int i = 0; i < features_.size(); ++i) {
      const Entry& entry = features_.entries[std::size_t(i)];
      model_.feature_texts.insert(model_.feature_texts.end(), {features_.text(i), entry.unit});
      for (const OwnColumn& column : own_columns) {
        if (entry.name != column.name || !column.is_said) continue;
        if (std::find(said.begin(), said.end(), entry.name) != said.end()) continue;
        said.push_back(entry.name);
        model_.column_names.push_back(entry.name);
        model_.column_units.push_back(entry.unit);
      }
      model_.input_mean.push_back(draw(-2, 2));
      model_.input_deviation.push_back(draw(0.5, 4));
      model_.envelope_lower.push_back(model_.input_mean.back() - 4 * model_.input_deviation.back());
      model_.envelope_upper.push_back(model_.input_mean.back() + 4 * model_.input_deviation.back());
    }
    model_.window_taps = static_cast<std::uint32_t>(features_.taps);
    model_.causal = features_.causal;
    model_.facts.sample_period_s = features_.taps > 1 ? features_.period_s : 0;
    model_.features_type = "none";
  }

  /// Centre of gravity within 3 cm of the middle; of every second one thrust is curved, and its axes of inertia are not
  /// the body's.
  Airframe<double> drawn_airframe() {
    Airframe<double> airframe = PaperQuadrotor::value<double>();
    const double back_m = uniform(engine_, -0.03, 0.03), left_m = uniform(engine_, -0.03, 0.03);
    const double curve = composer_.likely(0.5) ? 0.2 : 0;
    if (curve > 0) airframe.inertia_products_kg_m2 = {1.1e-3, -0.7e-3, 0.4e-3};
    for (std::size_t i = 0; i < rotor_count; ++i) {
      airframe.rotors[i].x_m += back_m;
      airframe.rotors[i].y_m += left_m;
      airframe.rotors[i].thrust_curve = curve * double(i);
    }
    return airframe;
  }
  template <class Schema>
  void take_outputs() {
    using Map = OutputMap<Schema>;
    const Airframe<double> airframe = drawn_airframe();
    model_.outputs_type = "none";
    model_.base = detail::description_text<typename detail::BaseOf<Schema>::type>();
    model_.output_texts = {detail::description_text<Schema>()};
    detail::append_texts(model_.output_texts, Map::names, Map::units);
    detail::take_airframe<Schema>(model_, PaperQuadrotor::name, airframe, airframe);
    model_.facts.command_meaning = command_meaning_of(airframe);
    for (int k = 0; k < Map::size; ++k) {
      model_.output_mean.push_back(draw(-0.1, 0.5));
      model_.output_deviation.push_back(draw(0.05, 0.3));
    }
  }

  void take_answer() {
    const std::string count = std::to_string(features_.size());
    const std::vector<int> threes = drawn_threes();
    axis_commands_ = !threes.empty();
    if (threes.empty()) {  // no structure: an affine network, which one derivative proves, or any other
      const std::string layers =
          composer_.likely(0.9) ? "pinnquad::Dense<4>" : "pinnquad::Dense<5>, pinnquad::Relu, pinnquad::Dense<4>";
      model_.answer = "pinnquad::Network<double, pinnquad::Inputs<" + count + ">, " + layers + ">";
      add_numbers(0.3);
      for (std::size_t rotor = 0; rotor < std::size_t(rotor_count) && layers.size() < 20; ++rotor) {
        for (std::size_t i = 0; i < std::size_t(features_.size()); ++i) {  // of an affine one that may be proven
          const Entry& entry = features_.entries[i];
          for (int axis = 0; axis < 3; ++axis) {
            if (entry.name != NamedFeatures::names[std::size_t(3 + axis)]) continue;
            const auto signs = allocation_signs(PaperQuadrotor::value<double>(), axis);
            model_.parameters[rotor * std::size_t(features_.size()) + i] =
                signs[rotor] * uniform(engine_, entry.tap == 0 ? 0.2 : -0.2, 0.5);
          }
        }
      }
      return;
    }
    std::string places;
    for (const int place : threes) places += ", " + std::to_string(place);
    const std::string base = "pinnquad::AxisAligned<double, " + count + places + ">";
    const int kind = composer_.below(5), others = features_.size() - 3 * int(threes.size());
    if (kind == 0) {
      model_.answer = base;
      add_affine(threes, others);
      return;
    }
    const bool masked = kind != 2 || composer_.likely(0.5);
    const std::string network = "pinnquad::Network<double, pinnquad::Inputs<" +
                                (masked ? std::to_string(others) : count) + ">, " + layers() + ">";
    const std::string shown = masked ? "pinnquad::Withheld<" + network + ", " + count + places + ">" : network;
    model_.answer = "pinnquad::Sum<" + base + ", pinnquad::Bounded<" + shown + ">>";
    add_affine(threes, others);
    for (int k = 0; k < 4; ++k) model_.parameters.push_back(draw(-3, -0.1));
    for (int k = 0; k < 4; ++k) model_.parameters.push_back(draw(0.1, 3));
    add_numbers(std::pow(10.0, uniform(engine_, -1, 0.5)));
  }

  std::string layers() {
    static const char* const known[] = {"Relu", "Tanh", "Softplus", "Gelu", "Silu", "Sine"};
    const std::string activation = known[composer_.below(6)];
    std::string text;
    for (int layer = composer_.below(3); layer > 0; --layer) {
      text += "pinnquad::Dense<" + std::to_string(2 + composer_.below(6)) + ">, pinnquad::" + activation + ", ";
    }
    return text + "pinnquad::Dense<4>";
  }

  /// Where the affine part has one slope per axis: at the angular acceleration of all taps, of some, anywhere.
  std::vector<int> drawn_threes() {
    std::vector<int> all = features_.threes;
    const int way = composer_.below(10);
    if (way == 0) return {};
    if (way == 1 && all.size() > 1) all.pop_back();
    if (way == 2 && features_.size() > 6) all.push_back(composer_.below(features_.size() - 3));
    std::sort(all.begin(), all.end());
    std::vector<int> apart;
    for (const int place : all) {
      if (apart.empty() || place >= apart.back() + 3) apart.push_back(place);
    }
    if (features_.size() - 3 * int(apart.size()) < 1) return {};
    return apart;
  }

  void add_affine(const std::vector<int>& threes, int others) {
    for (std::size_t tap = 0; tap < threes.size(); ++tap) {
      for (int axis = 0; axis < 3; ++axis) model_.parameters.push_back(tap == 0 ? draw(0.1, 1) : draw(-0.2, 0.6));
    }
    for (int i = 0; i < 4 * others + 4; ++i) model_.parameters.push_back(draw(-1.5, 1.5));
  }
  /// As many as the answer still lacks.
  void add_numbers(double largest) {
    RunTimeNetwork network;
    REQUIRE(network.parse(model_.answer));
    while (int(model_.parameters.size()) < network.parameter_count()) {
      model_.parameters.push_back(draw(-largest, largest));
    }
  }

  std::mt19937_64& engine_;
  Composer composer_;
  const Composition& features_;
  detail::WrittenModel<double> model_;
  bool axis_commands_ = false;
};

/// Four sums of the commands of motions.
class SignedSumsOfMotions {
 public:
  explicit SignedSumsOfMotions(const RunTimeModel<double>& model)
      : model_(model), x_(std::size_t(model.features().size())), work_(model.workspace()) {}

  std::array<double, 4> operator()(const std::vector<RunTimeFeatures::Inputs<double>>& taps) {
    model_.features().extract(taps.data(), x_.data());
    double u[4];
    model_.commands(x_.data(), static_cast<double*>(u), work_.data());
    largest_ = 1;
    for (int i = 0; i < model_.features().size(); ++i) {
      if (!model_.features().is_column(i))
        largest_ += std::abs(x_[std::size_t(i)]) / model_.scales().input_deviation[i];
    }
    std::array<double, 4> sums{};
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t rotor = 0; rotor < 4; ++rotor) sums[k] += mix_.signs[k][rotor] * u[rotor];
      largest_ = std::max(largest_, std::abs(u[k]));
    }
    return sums;
  }
  /// A bound on what rounding does to a sum of the last motion.
  double doubt() const { return 1e-12 * largest_; }

 private:
  const RunTimeModel<double>& model_;
  const detail::SignedMix<double> mix_ = detail::signed_mix(model_.airframe());
  std::vector<double> x_, work_;
  double largest_ = 1;
};

struct Refuted {
  long pairs = 0, fell = 0, below_proven = 0, moved_others = 0, less_thrust = 0;
};

Refuted search_of(const RunTimeModel<double>& model, const BlockModel::ProvenSigns& proof, int pairs,
                  std::mt19937_64& engine) {
  const std::optional<Certificate>& certificate = proof.structure;
  SignedSumsOfMotions sums_of(model);
  RandomStates random(engine());
  const auto taps = std::size_t(model.features().window().taps);
  std::vector<RunTimeFeatures::Inputs<double>> motion(taps);
  // the slope of a curve is known while its commands are in 0 to 1 (outputs/rigid_body_base.cpp)
  const bool curved_base = model.records().base.count != 0 && model.airframe().rotors[3].thrust_curve > 0;
  Refuted found;
  for (int pair = 0; pair < pairs; ++pair) {
    const double largest = std::pow(10.0, uniform(engine, -1, 2));
    for (RunTimeFeatures::Inputs<double>& tap : motion) {
      tap.linear_acceleration_m_s2 = random.vector<double>(largest);
      tap.angular_acceleration_rad_s2 = random.vector<double>(3 * largest);
      tap.velocity_m_s = random.vector<double>(largest);
      tap.body_rates_rad_s = random.vector<double>(largest);
      if (pair % 8 == 0) tap.attitude = random.attitude<double>();
      tap.altitude_m = random.scalar<double>(0, largest);
      for (int i = 0; i < model.features().column_count(); ++i) {
        tap.columns[std::size_t(i)] = random.scalar<double>(-largest, largest);
      }
    }
    const auto axis = std::size_t(pair % 3);
    const bool held = pair % 2 == 0;
    const double step = (pair % 4 < 2 ? 1 : -1) * std::pow(10.0, uniform(engine, -3, 3));
    std::vector<RunTimeFeatures::Inputs<double>> more = motion;
    for (std::size_t tap = 0; tap < (held ? taps : 1); ++tap) {
      more[tap].angular_acceleration_rad_s2[int(axis)] += step;
      for (int i = 0; i < model.features().column_count(); ++i) {
        for (const OwnColumn& column : own_columns) {
          if (model.features().column(i).name != column.name || column.axis != int(axis)) continue;
          more[tap].columns[std::size_t(i)] += column.share * step;
        }
      }
    }
    const auto before = sums_of(motion);
    double doubt = sums_of.doubt();
    const auto after = sums_of(more);
    doubt += sums_of.doubt();
    const double rise = (after[1 + axis] - before[1 + axis]) * (step < 0 ? -1 : 1), size = std::abs(step);
    const double least = held ? proof.held_slope[axis] : proof.slope[axis];
    ++found.pairs;
    found.fell += rise < -doubt ? 1 : 0;
    found.below_proven += rise < least * (1 - 1e-9) * size - doubt ? 1 : 0;
    if (!certificate) continue;
    double others = 0;
    for (std::size_t k = 0; k < 4; ++k) others += k == 1 + axis ? 0 : std::abs(after[k] - before[k]);
    found.moved_others += others > 3 * doubt ? 1 : 0;
    if (curved_base) continue;
    std::vector<RunTimeFeatures::Inputs<double>> stronger = motion;
    for (std::size_t tap = 0; tap < (held ? taps : 1); ++tap) stronger[tap].linear_acceleration_m_s2[2] -= size;
    const double more_thrust = sums_of(stronger)[0] - before[0];
    const double of_base = size * (held ? certificate->held_thrust_slope : certificate->thrust_slope);
    const double less = certificate->residual_upper[0] - certificate->residual_lower[0] + 1e-9 * std::abs(of_base);
    found.less_thrust += more_thrust < of_base - less - doubt - sums_of.doubt() ? 1 : 0;
  }
  return found;
}

}  // namespace

TEST_CASE("a search over random feature sets, structures and weights refutes no proof" * doctest::timeout(3600)) {
  const int wanted = from_environment("PINNQUAD_SEARCHED_COMPOSITIONS", 60);
  const int pairs = from_environment("PINNQUAD_SEARCHED_PAIRS", 60);
  std::mt19937_64 engine(1);
  Refuted all;
  int made = 0, proven = 0, refuted = 0;
  std::string first;
  for (; proven < wanted && made < 100 * wanted; ++made) {
    const Composition composition = Composer(engine).compose();
    const auto bytes = Maker(engine, composition).block();
    const BlockModel model("searched.block", bytes);
    const std::optional<BlockModel::ProvenSigns> proof = model.proven_signs();
    if (!proof) continue;
    ++proven;
    const test::BlockBytes aligned(bytes);
    const auto own = std::make_unique<RunTimeModel<double>>();
    REQUIRE(RunTimeModel<double>::open(aligned.data(), aligned.size(), *own) == Status::ok);
    const Refuted found = search_of(*own, *proof, pairs, engine);
    all.pairs += found.pairs;
    all.fell += found.fell;
    all.below_proven += found.below_proven;
    all.moved_others += found.moved_others;
    all.less_thrust += found.less_thrust;
    if (found.fell + found.below_proven + found.moved_others + found.less_thrust == 0) continue;
    ++refuted;
    if (!first.empty()) continue;
    first = model.answer() + " of";
    for (const std::string& name : model.feature_names()) first += " " + name;
  }
  MESSAGE(made << " compositions, " << proven << " proven, " << all.pairs << " pairs of motions");
  INFO(first);
  CHECK(proven == wanted);
  CHECK(refuted == 0);
  CHECK(all.fell == 0);
  CHECK(all.below_proven == 0);
  CHECK(all.moved_others == 0);
  CHECK(all.less_thrust == 0);
}
