// SPDX-License-Identifier: MIT
// An answer that is known at run time alone: a network, or a sum of some (model/predictor.hpp), from its description.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "training/run_time_network.hpp"

namespace programs {

/// The networks of a description: one, or those of "pinnquad::Sum<First, Second>", sums of sums among them. Nothing for
/// any other text, and for networks that do not fit together.
inline std::optional<std::vector<NetworkSpec>> parse_answer(const std::string& description) {
  const std::string head = "pinnquad::Sum<";
  const std::size_t begin = description.find_first_not_of(' ');
  if (begin == std::string::npos || description.compare(begin, head.size(), head) != 0) {
    std::optional<NetworkSpec> network = parse_network(description);
    if (!network) return {};
    return std::vector<NetworkSpec>{*network};
  }
  const std::size_t last = description.find_last_not_of(' ');
  if (description[last] != '>') return {};
  const std::string inside = description.substr(begin + head.size(), last - begin - head.size());
  int depth = 0;
  std::size_t comma = std::string::npos;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    depth += inside[i] == '<' ? 1 : (inside[i] == '>' ? -1 : 0);
    if (inside[i] == ',' && depth == 0) {
      if (comma != std::string::npos) return {};
      comma = i;
    }
  }
  if (comma == std::string::npos) return {};
  std::optional<std::vector<NetworkSpec>> networks = parse_answer(inside.substr(0, comma));
  const std::optional<std::vector<NetworkSpec>> second = parse_answer(inside.substr(comma + 1));
  if (!networks || !second) return {};
  networks->insert(networks->end(), second->begin(), second->end());
  for (const NetworkSpec& network : *networks) {
    const NetworkSpec& first = networks->front();
    if (network.inputs != first.inputs || network.outputs() != first.outputs() || network.scalar != first.scalar)
      return {};
  }
  return networks;
}

inline long long parameter_count(const std::vector<NetworkSpec>& networks) {
  long long count = 0;
  for (const NetworkSpec& network : networks) count += network.parameter_count();
  return count;
}

/// Each network with its own of the parameters, which lie one network after the other.
template <class Scalar>
std::vector<RunTimeNetwork<Scalar>> summands(const std::vector<NetworkSpec>& networks,
                                             const std::vector<double>& parameters) {
  std::vector<RunTimeNetwork<Scalar>> all;
  auto own = parameters.begin();
  for (const NetworkSpec& network : networks) {
    const auto end = own + network.parameter_count();
    all.emplace_back(network, std::vector<double>(own, end));
    own = end;
  }
  return all;
}

/// y = the sum of networks(x).
template <class Scalar>
class RunTimeAnswer {
 public:
  RunTimeAnswer(const std::vector<NetworkSpec>& networks, const std::vector<double>& parameters)
      : networks_(summands<Scalar>(networks, parameters)) {}

  std::vector<Scalar> forward(const std::vector<Scalar>& x) const {
    std::vector<Scalar> y = networks_.front().forward(x);
    for (std::size_t i = 1; i < networks_.size(); ++i) {
      const std::vector<Scalar> other = networks_[i].forward(x);
      for (std::size_t k = 0; k < y.size(); ++k) y[k] += other[k];
    }
    return y;
  }

 private:
  std::vector<RunTimeNetwork<Scalar>> networks_;
};

}  // namespace programs
