// SPDX-License-Identifier: MIT
// Finds out what model a block is: a block names its answer, features, outputs and vehicle by a hash, so those that the
// program knows are tried until one has it.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "airframe/choice.hpp"
#include "model/block.hpp"
#include "model/run_time_answer.hpp"
#include "pinnquad/deploy/provenance.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/loss/context.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"

namespace programs {

/// Feature sets and output schemas that a row of a flight is enough for; `function` is called with a value of each
/// pair.
template <class Function>
void each_schema(const Function& function) {
  using namespace pinnquad;
  function(PaperFeatures{}, CommandOutputs{});
  function(PaperFeatures{}, RotorSpeedOutputs{});
  function(PaperFeaturesWithAltitude{}, CommandOutputs{});
  function(PaperFeaturesWithAltitude{}, RotorSpeedOutputs{});
  function(PhysicsFeatures{}, AxisCommandOutputs{});
  function(InverseFeatures{}, AxisCommandOutputs{});
  function(InverseFeaturesWithAltitude{}, AxisCommandOutputs{});
}

/// Statements of a user and of an exported header about a model, which narrow what is tried. Empty: all is tried.
struct ModelHints {
  std::string airframe;              ///< a name or a file
  std::string answer;                ///< the network as a header states it
  std::optional<NamedAirframe> own;  ///< that the header brings with it; `airframe` goes before it
};

using RunTimeAirframe = pinnquad::GivenAirframe;

/// The model that a block is.
struct Identity {
  std::string answer;                 ///< description of the network
  std::vector<NetworkSpec> networks;  ///< of a sum more than one
  NamedAirframe airframe;
  std::string features, outputs;  ///< first and last name of each, for a reader
};

namespace detail {

/// Description of what outputs are added to; "" where they stand alone.
template <class Outputs>
std::string base_of() {
  return pinnquad::detail::description_text<typename pinnquad::detail::BaseOf<Outputs>::type>();
}

/// As pinnquad::detail::hash_of_shape, for an answer that is a text.
template <class Features, class Outputs>
std::uint64_t shape_hash_of(const std::string& answer, const NamedAirframe& airframe) {
  using Map = pinnquad::OutputMap<Outputs>;
  pinnquad::detail::Fnv1a fnv;
  fnv.absorb_text(answer);
  pinnquad::detail::absorb_shape(fnv, Features::names, Features::units, Map::names, Map::units,
                                 pinnquad::printable(airframe.name), pinnquad::motor_torque_signs(airframe.value));
  return fnv.hash;
}

/// "Network<float, Inputs<16>, Dense<25>, Relu, ..., Dense<4>>" with hidden layers of one width.
inline std::string uniform_network(bool is_double, long long inputs, long long outputs, int layers, int width,
                                   const char* activation) {
  std::string text = std::string("pinnquad::Network<") + (is_double ? "double" : "float") + ", pinnquad::Inputs<" +
                     std::to_string(inputs) + ">";
  for (int i = 0; i < layers; ++i) {
    text += ", pinnquad::Dense<" + std::to_string(width) + ">, ";
    text += activation;
  }
  return text + ", pinnquad::Dense<" + std::to_string(outputs) + ">>";
}

/// Networks with hidden layers of one width that have `wanted` parameters.
inline std::vector<std::string> uniform_networks(bool is_double, long long in, long long out, long long wanted) {
  constexpr int most_layers = 64, widest = 4096;
  std::vector<std::string> all;
  if (in * out + out == wanted) all.push_back(uniform_network(is_double, in, out, 0, 0, ""));
  for (int layers = 1; layers <= most_layers; ++layers) {
    for (long long width = 1; width <= widest; ++width) {
      const long long count = (in + 1) * width + (layers - 1) * (width + 1) * width + (width + 1) * out;
      if (count > wanted) break;
      if (count < wanted) continue;
      for (const Activation<double>& activation : activations<double>()) {
        all.push_back(uniform_network(is_double, in, out, layers, static_cast<int>(width), activation.description));
      }
    }
  }
  return all;
}

/// Monotone models of `Features`, by themselves or with a uniform network, that have as many parameters as the block.
template <class Features>
void add_monotone_answers(const Block& block, std::vector<std::string>& all) {
  if (block.inputs != Features::size || block.outputs != pinnquad::AxisCommandOutputs::size) return;
  const auto wanted = static_cast<long long>(block.parameter_count);
  const std::string places =
      ", " + std::to_string(Features::size) + ", " + std::to_string(Features::angular_acceleration) + ">";
  const std::string base = std::string("pinnquad::AxisAligned<") + (block.is_double ? "double" : "float") + places;
  const long long left = wanted - parse_network(base)->parameter_count();
  if (left == 0) all.push_back(base);
  for (const std::string& residual :
       uniform_networks(block.is_double, block.inputs - 3, block.outputs, left - 2 * block.outputs)) {
    all.push_back("pinnquad::Sum<" + base + ", pinnquad::Bounded<pinnquad::Withheld<" + residual + places + ">>");
  }
  for (const std::string& residual :
       uniform_networks(block.is_double, block.inputs, block.outputs, left - 2 * block.outputs)) {
    const std::string answer =
        "pinnquad::Sum<" + base + ", pinnquad::Bounded<pinnquad::PathBounded<" + residual + ">>>";
    if (parse_answer(answer)) all.push_back(answer);
  }
}

/// Answers that have as many parameters as the block: uniform networks, and monotone models with one.
inline std::vector<std::string> candidate_answers(const Block& block) {
  std::vector<std::string> all =
      uniform_networks(block.is_double, block.inputs, block.outputs, static_cast<long long>(block.parameter_count));
  add_monotone_answers<pinnquad::PhysicsFeatures>(block, all);
  add_monotone_answers<pinnquad::InverseFeatures>(block, all);
  add_monotone_answers<pinnquad::InverseFeaturesWithAltitude>(block, all);
  return all;
}

/// The airframes to try: the one that is named or in a file, else the header's own, else all that the program knows.
inline std::vector<NamedAirframe> candidate_airframes(const ModelHints& hints) {
  const std::string& wanted = hints.airframe;
  if (is_airframe_file(wanted)) return {read_airframe_file(wanted)};
  if (wanted.empty() && hints.own) return {*hints.own};
  std::vector<NamedAirframe> all;
  each_airframe([&](auto tag) {
    using Vehicle = typename decltype(tag)::type;
    if (wanted.empty() || wanted == Vehicle::name) {
      all.push_back({Vehicle::name, pinnquad::airframe_value<Vehicle, double>()});
    }
  });
  if (all.empty()) throw no_airframe(wanted);
  return all;
}

}  // namespace detail

/// Finds out which model a block is; nothing where none has the block's hash. `each(function)` calls it with every pair
/// of feature set and output schema to try, as each_schema() does.
template <class Each>
std::optional<Identity> find_identity(const Block& block, const ModelHints& hints, const Each& each) {
  const std::vector<NamedAirframe> airframes = detail::candidate_airframes(hints);
  std::vector<std::string> answers = {hints.answer};
  if (hints.answer.empty()) answers = detail::candidate_answers(block);
  std::optional<Identity> found;
  each([&](auto features, auto outputs) {
    using Features = decltype(features);
    using Outputs = decltype(outputs);
    using Map = pinnquad::OutputMap<Outputs>;
    if (found || Features::size != block.inputs || Map::size != block.outputs) return;
    if (detail::base_of<Outputs>() != block.base) return;
    for (const std::string& text : answers) {
      for (const NamedAirframe& candidate : airframes) {
        if (detail::shape_hash_of<Features, Outputs>(text, candidate) != block.shape_hash) continue;
        const std::optional<std::vector<NetworkSpec>> networks = parse_answer(text);
        if (!networks || static_cast<std::size_t>(parameter_count(*networks)) != block.parameter_count ||
            networks->front().inputs != block.inputs || networks->front().outputs() != block.outputs ||
            (networks->front().scalar == "double") != block.is_double) {
          continue;
        }
        found =
            Identity{text, *networks, candidate, std::string(Features::names.front()) + ".." + Features::names.back(),
                     std::string(Map::names.front()) + ".." + Map::names.back()};
        return;
      }
    }
  });
  return found;
}

/// Of those that `train` exports: which a row of a flight is enough for, and which it fits to logs.
std::optional<Identity> find_identity(const Block& block, const ModelHints& hints);

/// The same. Throws std::invalid_argument, one line, where nothing has the block's hash.
Identity identify(const Block& block, const ModelHints& hints);

}  // namespace programs
