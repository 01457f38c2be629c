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
#include <map>
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
    std::vector<std::string> present = part(0.9);
    if (all.begins_as_physics) present = joined({0, 1, 2}, present);
    add(all, present, 0);
    // of each other tap the same part, as of a window, or any
    const std::vector<std::string> other = part(0.4);
    for (int tap = 1; tap < all.taps; ++tap) add(all, likely(0.7) ? other : part(0.4), tap);
    for (int i = 0; i + 2 < all.size(); ++i) {
      const auto is_axis = [&](int k, const char* name) {
        const Entry& entry = all.entries[std::size_t(i + k)];
        return entry.name == name && entry.tap == all.entries[std::size_t(i)].tap;
      };
      if (is_axis(0, "wdot_x") && is_axis(1, "wdot_y") && is_axis(2, "wdot_z")) all.threes.push_back(i);
    }
    return all;
  }

  bool likely(double share) { return uniform(engine_, 0, 1) < share; }
  int below(int count) { return int(engine_() % std::uint64_t(count)); }

 private:
  /// Parts of the library by their first names' places among NamedFeatures, and how many they are.
  static constexpr std::array<int, 2> parts[] = {{16, 3}, {3, 3}, {9, 3},  {19, 3}, {22, 3}, {6, 3},
                                                 {25, 3}, {0, 3}, {12, 2}, {14, 2}, {18, 1}};

  static void append(std::vector<std::string>& to, const std::string& name) {
    if (std::find(to.begin(), to.end(), name) == to.end()) to.push_back(name);
  }
  static std::vector<std::string> joined(const std::vector<std::size_t>& first, const std::vector<std::string>& rest) {
    std::vector<std::string> all;
    for (const std::size_t at : first) {
      for (int i = 0; i < parts[at][1]; ++i) append(all, NamedFeatures::names[std::size_t(parts[at][0] + i)]);
    }
    for (const std::string& name : rest) append(all, name);
    return all;
  }
  /// Parts in any order, chosen places, columns; `turning`: how likely it has the angular acceleration whole.
  std::vector<std::string> part(double turning) {
    std::vector<std::string> all;
    const int pieces = 1 + below(4);
    const int whole_at = likely(turning) ? below(pieces + 1) : -1;
    for (int piece = 0; piece <= pieces; ++piece) {
      if (piece == whole_at) all = joined({}, with(all, {"wdot_x", "wdot_y", "wdot_z"}));
      if (likely(0.6)) {
        const auto& [first, count] = parts[std::size_t(below(int(std::size(parts))))];
        for (int i = 0; i < count && first != 3; ++i) append(all, NamedFeatures::names[std::size_t(first + i)]);
      } else if (likely(0.8)) {  // any place, a lone angular acceleration among them
        append(all, NamedFeatures::names[std::size_t(below(NamedFeatures::size))]);
      } else if (likely(0.3)) {
        append(all, NamedFeatures::names[std::size_t(3 + below(3))]);
      } else if (likely(0.2)) {
        append(all, "altitude");
      } else {
        append(all, own_columns[std::size_t(below(likely(0.6) ? 3 : int(std::size(own_columns))))].name);
      }
    }
    if (all.empty()) all.emplace_back("w_x");
    return all;
  }
  static std::vector<std::string> with(std::vector<std::string> all, const std::vector<std::string>& more) {
    for (const std::string& name : more) all.erase(std::remove(all.begin(), all.end(), name), all.end());
    all.insert(all.end(), more.begin(), more.end());
    return all;
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
template <class Scalar>
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
    const auto read = std::make_unique<RunTimeModel<Scalar>>();
    const Status status = RunTimeModel<Scalar>::open(first.data(), first.size(), *read);
    INFO("expected " << (read->fault().expected == nullptr ? "" : read->fault().expected));
    INFO(model_.answer);
    REQUIRE(status == Status::ok);
    std::vector<Scalar> work(read->workspace());
    read->commands(model_.input_mean.data(), model_.golden_commands[0].data(), work.data());
    return detail::block_beside_header(model_);
  }

 private:
  Scalar draw(double lower, double upper) { return static_cast<Scalar>(uniform(engine_, lower, upper)); }

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
    detail::take_airframe<Schema>(model_, PaperQuadrotor::name, airframe, airframe_in<Scalar>(airframe));
    model_.facts.command_meaning = command_meaning_of(airframe);
    for (int k = 0; k < Map::size; ++k) {
      model_.output_mean.push_back(draw(-0.1, 0.5));
      model_.output_deviation.push_back(draw(0.05, 0.3));
    }
  }

  void take_answer() {
    const std::string scalar = sizeof(Scalar) == 8 ? "double" : "float", count = std::to_string(features_.size());
    const std::vector<int> threes = drawn_threes();
    axis_commands_ = !threes.empty();
    if (threes.empty()) {  // no structure: an affine network, which one derivative proves, or any other
      const std::string layers =
          composer_.likely(0.9) ? "pinnquad::Dense<4>" : "pinnquad::Dense<5>, pinnquad::Relu, pinnquad::Dense<4>";
      model_.answer = "pinnquad::Network<" + scalar + ", pinnquad::Inputs<" + count + ">, " + layers + ">";
      add_numbers(0.3);
      for (std::size_t rotor = 0; rotor < std::size_t(rotor_count) && layers.size() < 20; ++rotor) {
        for (std::size_t i = 0; i < std::size_t(features_.size()); ++i) {  // of an affine one that may be proven
          const Entry& entry = features_.entries[i];
          for (int axis = 0; axis < 3; ++axis) {
            if (entry.name != NamedFeatures::names[std::size_t(3 + axis)]) continue;
            const auto signs = allocation_signs(PaperQuadrotor::value<double>(), axis);
            model_.parameters[rotor * std::size_t(features_.size()) + i] =
                static_cast<Scalar>(signs[rotor] * uniform(engine_, entry.tap == 0 ? 0.2 : -0.2, 0.5));
          }
        }
      }
      return;
    }
    std::string places;
    for (const int place : threes) places += ", " + std::to_string(place);
    const std::string base = "pinnquad::AxisAligned<" + scalar + ", " + count + places + ">";
    const int kind = composer_.below(5), others = features_.size() - 3 * int(threes.size());
    if (kind == 0) {
      model_.answer = base;
      add_affine(threes, others);
      return;
    }
    const bool masked = kind != 2 || composer_.likely(0.5);
    const std::string network = "pinnquad::Network<" + scalar + ", pinnquad::Inputs<" +
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
  detail::WrittenModel<Scalar> model_;
  bool axis_commands_ = false;
};

/// Four sums of the commands of motions, in double, whatever the numbers of the model are held in.
template <class Scalar>
class SumsInDouble {
 public:
  explicit SumsInDouble(const RunTimeModel<Scalar>& model)
      : model_(model), x_(std::size_t(model.features().size())), in_(x_.size()), work_(model.network().workspace()) {
    REQUIRE(outputs_.find(model.schema()));
    outputs_.prepare(model.airframe());
    mix_ = detail::signed_mix(model.airframe());
  }
  std::array<double, 4> operator()(const std::vector<RunTimeFeatures::Inputs<double>>& taps) {
    model_.features().extract(taps.data(), x_.data());
    const auto& scales = model_.scales();
    largest_ = 1;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      in_[i][0] = (x_[i] - double(scales.input_mean[i])) / double(scales.input_deviation[i]);
      if (model_.features().is_column(int(i))) {
        const double mean = double(scales.input_mean[i]), deviation = double(scales.input_deviation[i]);
        const double least = double(scales.lower[i]) - mean, most = double(scales.upper[i]) - mean;
        in_[i][0] = std::clamp(in_[i][0], least / deviation, most / deviation);
      }
      largest_ += std::abs(in_[i][0]);
    }
    Number y[4];
    model_.network().template forward<double, 1>(model_.parameters(), in_.data(), static_cast<Number*>(y),
                                                 work_.data());
    double outputs[4], u[4];
    for (int k = 0; k < 4; ++k) {
      outputs[k] = y[k][0] * double(scales.output_deviation[k]) + double(scales.output_mean[k]);
    }
    outputs_.commands(x_.data(), static_cast<const double*>(outputs), static_cast<double*>(u));
    std::array<double, 4> sums{};
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t rotor = 0; rotor < 4; ++rotor) {
        sums[k] += mix_.signs[k][rotor] * u[rotor];
        largest_ = std::max(largest_, std::abs(u[rotor]));
      }
    }
    return sums;
  }
  /// A bound on what rounding in double does to a sum of the last motion.
  double doubt() const { return 1e-12 * largest_; }

 private:
  using Number = RunTimeNetwork::Values<double, 1>;
  const RunTimeModel<Scalar>& model_;
  RunTimeOutputs<double> outputs_;
  detail::SignedMix<double> mix_;
  std::vector<double> x_;
  std::vector<Number> in_, work_;
  double largest_ = 1;
};

struct Refuted {
  long pairs = 0, fell = 0, below_proven = 0, moved_others = 0, less_thrust = 0;
};

template <class Scalar>
Refuted search_of(const RunTimeModel<Scalar>& model, const BlockModel::ProvenSigns& proof, int pairs,
                  std::mt19937_64& engine) {
  const std::optional<Certificate>& certificate = proof.structure;
  SumsInDouble<Scalar> sums_of(model);
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

std::string kind_of(const BlockModel& model, const BlockModel::ProvenSigns& proof) {
  if (!proof.structure) return "affine";
  return (model.network().part_count() == 1 ? "base alone" : "residual") +
         std::string(model.with([](const auto& own) { return own.records().base.count != 0; }) ? " on a base" : "") +
         (model.features().window().taps > 1 ? ", window" : "") + (model.columns().empty() ? "" : ", column");
}

}  // namespace

TEST_CASE("a search over random feature sets, structures and weights refutes no proof" * doctest::timeout(3600)) {
  const int wanted = from_environment("PINNQUAD_SEARCHED_COMPOSITIONS", 60);
  const int pairs = from_environment("PINNQUAD_SEARCHED_PAIRS", 60);
  std::mt19937_64 engine(1);
  std::map<std::string, int> kinds;
  Refuted all;
  int made = 0, proven = 0, refuted = 0;
  std::string first;
  for (; proven < wanted && made < 100 * wanted; ++made) {
    const Composition composition = Composer(engine).compose();
    const bool in_double = Composer(engine).likely(0.3);
    const auto bytes =
        in_double ? Maker<double>(engine, composition).block() : Maker<float>(engine, composition).block();
    const BlockModel model("searched.block", bytes);
    const std::optional<BlockModel::ProvenSigns> proof = model.proven_signs();
    if (!proof) continue;
    ++proven;
    ++kinds[kind_of(model, *proof)];
    const Refuted found = model.with([&](const auto& own) { return search_of(own, *proof, pairs, engine); });
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
  std::string said;
  for (const auto& [kind, count] : kinds) said += "\n  " + std::to_string(count) + " " + kind;
  MESSAGE(made << " compositions, " << proven << " proven, " << all.pairs << " pairs of motions; refuted " << refuted
               << " compositions: sums that fell " << all.fell << ", rose by less than proven " << all.below_proven
               << ", moved other sums by more " << all.moved_others << ", rose by less than proven with thrust "
               << all.less_thrust << "; proven were" << said);
  INFO(first);
  CHECK(proven == wanted);
  CHECK(refuted == 0);
  CHECK(all.fell == 0);
  CHECK(all.below_proven == 0);
  CHECK(all.moved_others == 0);
  CHECK(all.less_thrust == 0);
}
