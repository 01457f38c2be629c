// SPDX-License-Identifier: MIT
// The trainings of Table 2, compiled here and nowhere else.
#include "study/table.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line/parse_decimal.hpp"
#include "study/models.hpp"

namespace study {

namespace {

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

/// All models of Table 2, top to bottom.
std::vector<Contender> table_2() {
  std::vector<Contender> result;
  each_model([&](auto row) { result.push_back(table_contender(row)); });
  return result;
}

}  // namespace

std::vector<Contender> chosen_models(const std::string& list) {
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
    constexpr int greatest = 999999999;
    if (!programs::parse_decimal(item.substr(0, dash), 0, greatest, first) ||
        !programs::parse_decimal(dash == std::string::npos ? item : item.substr(dash + 1), 0, greatest, last) ||
        last < first) {
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

}  // namespace study
