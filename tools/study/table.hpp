// SPDX-License-Identifier: MIT
// Table 2 as contenders, and the choice of some of them on the command line.
#pragma once

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "study/contender.hpp"
#include "study/models.hpp"

namespace study {

namespace detail {

template <class ModelType>
Contender table_contender(ModelType /*row*/) {
  using Structure = typename ModelType::Structure;
  using Lambda = typename ModelType::Lambda;
  using DataSet = typename ModelType::DataSet;
  using BatchNorm = typename ModelType::BatchNorm;
  using Network = PaperNetwork<typename DataSet::Features, BatchNorm>;
  using Order = pinnquad::ShuffledBatches;
  const std::string id = std::to_string(ModelType::id);
  const nlohmann::json description = {
      {"structure", Structure::name}, {"batch_norm", BatchNorm::batch_norm}, {"lambda", Lambda::name}};
  Contender result;
  if constexpr (std::is_same_v<Structure, Linearized>) {
    result = linear_contender<DataSet>(id, description);
  } else if constexpr (std::is_same_v<Structure, Vanilla>) {
    result = trained_contender<DataSet, Network, Order>(id, description, pinnquad::Mse{}, optimizer(vanilla_decay));
  } else if constexpr (std::is_same_v<Lambda, ConstantLambda>) {
    result = trained_contender<DataSet, Network, Order>(id, description, physics_loss(constant_weight()),
                                                        optimizer(informed_decay));
  } else {
    result = trained_contender<DataSet, Network, Order>(id, description, physics_loss(annealed_weight()),
                                                        optimizer(informed_decay));
  }
  result.more_flights = ModelType::more_flights;
  return result;
}

/// A whole number of at most 9 digits. False if the text is none.
inline bool parse_natural(const std::string& text, int& value) {
  if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != std::string::npos) return false;
  value = std::stoi(text);
  return true;
}

}  // namespace detail

/// All models of Table 2, top to bottom.
inline std::vector<Contender> table_2() {
  std::vector<Contender> result;
  each_model([&](auto row) { result.push_back(detail::table_contender(row)); });
  return result;
}

/// The models that a list such as "2,4,5-8" names, in the order of Table 2; an empty list names all.
/// Throws std::invalid_argument, one line, for a number that Table 2 does not have and for text that is no list.
inline std::vector<Contender> chosen_models(const std::string& list) {
  std::vector<Contender> all = table_2();
  if (list.empty()) return all;
  std::set<std::string> wanted;
  std::size_t begin = 0;
  while (begin <= list.size()) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string item = list.substr(begin, end - begin);
    begin = end + 1;
    const std::size_t dash = item.find('-');
    int first = 0, last = 0;
    if (!detail::parse_natural(item.substr(0, dash), first) ||
        !detail::parse_natural(dash == std::string::npos ? item : item.substr(dash + 1), last) || last < first) {
      throw std::invalid_argument("--models " + list + ": expected numbers and ranges such as 2,4,5-8, found '" + item +
                                  "'");
    }
    const int most = static_cast<int>(all.size());
    if (first < 1 || last > most) {
      throw std::invalid_argument("--models " + list + ": no model " + std::to_string(first < 1 ? first : last) +
                                  " in Table 2; known: 1-" + std::to_string(most));
    }
    for (int id = first; id <= last; ++id) wanted.insert(std::to_string(id));
  }
  std::vector<Contender> result;
  for (Contender& contender : all) {
    if (wanted.count(contender.id) > 0) result.push_back(std::move(contender));
  }
  return result;
}

/// Part `index` of `count`, from 1: "2/8".
struct Shard {
  int index = 1;
  int count = 1;
};

/// Throws std::invalid_argument, one line.
inline Shard parse_shard(const std::string& text) {
  Shard shard;
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos || !detail::parse_natural(text.substr(0, slash), shard.index) ||
      !detail::parse_natural(text.substr(slash + 1), shard.count) || shard.index < 1 || shard.index > shard.count) {
    throw std::invalid_argument("--shard " + text + ": expected i/n with i from 1 to n, such as 2/8");
  }
  return shard;
}

}  // namespace study
