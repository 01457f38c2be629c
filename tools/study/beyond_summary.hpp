// SPDX-License-Identifier: MIT
// Results of the command `beyond`: a table per condition on the terminal, on a page and as JSON, each model beside the
// paper's network of the same flight and seed.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "pinnquad/evaluation/paired_test.hpp"
#include "pinnquad/evaluation/summary.hpp"
#include "study/beyond_conditions.hpp"
#include "study/beyond_models.hpp"
#include "study/beyond_rows.hpp"

namespace study {

/// Rows of one model under one condition: figures by column, by flight seed and seed.
using BeyondCell = std::map<std::pair<std::uint64_t, std::uint64_t>, std::map<std::string, double>>;

inline std::map<std::string, std::map<std::string, BeyondCell>> beyond_cells(const StoredRows& stored) {
  const std::string header = beyond_header();
  std::vector<std::string_view> names, fields;
  pinnquad::split_fields(header, names);
  std::map<std::string, std::map<std::string, BeyondCell>> cells;
  for (const auto& [id, line] : stored.rows) {
    pinnquad::split_fields(line, fields);
    auto& figures = cells[id.flight][id.model][{id.flight_seed, id.seed}];
    constexpr std::size_t first_figure = 6;
    for (std::size_t i = first_figure; i < fields.size(); ++i) {
      double value = pinnquad::not_a_number;
      std::from_chars(fields[i].data(), fields[i].data() + fields[i].size(), value);
      figures[std::string(names[i])] = value;
    }
  }
  return cells;
}

/// A figure of a model and of the yardstick, pair by pair; a model without seeds stands beside each of the yardstick's.
inline std::pair<std::vector<double>, std::vector<double>> figure_pairs(const BeyondCell& model, const BeyondCell& by,
                                                                        const std::string& figure) {
  std::pair<std::vector<double>, std::vector<double>> pairs;
  for (const auto& [seeds, figures] : by) {
    auto found = model.find(seeds);
    if (found == model.end()) found = model.find({seeds.first, 0});
    if (found == model.end()) continue;
    const double value = found->second.at(figure), other = figures.at(figure);
    if (!std::isfinite(value - other)) continue;
    pairs.first.push_back(value);
    pairs.second.push_back(other);
  }
  return pairs;
}

/// {condition: {model: {figure: {mean, deviation, count, and of a paired one ratio, wins, pairs, p_value}}}}. Paired:
/// the error, and those of the closed loop.
inline nlohmann::json beyond_json(const StoredRows& stored) {
  std::vector<std::string> paired = {"mean_absolute_error"};
  for (const char* trajectory : loop_trajectories) paired.push_back(std::string(trajectory) + "_rmse_m");
  nlohmann::json result = nlohmann::json::object();
  for (const auto& [condition, models] : beyond_cells(stored)) {
    for (const auto& [model, cell] : models) {
      nlohmann::json& entry = result[condition][model];
      std::map<std::string, std::vector<double>> columns;
      for (const auto& [seeds, figures] : cell) {
        for (const auto& [name, value] : figures) columns[name].push_back(value);
      }
      for (const auto& [name, values] : columns) {
        const pinnquad::Summary summary = pinnquad::summarize(values);
        entry[name] = {{"mean", summary.mean}, {"deviation", summary.deviation}, {"count", summary.count}};
      }
      const auto by = models.find(yardstick);
      if (by == models.end()) continue;
      for (const std::string& figure : paired) {
        const auto pairs = figure_pairs(cell, by->second, figure);
        if (pairs.first.empty() || pairs.first.size() > pinnquad::most_pairs) continue;
        const pinnquad::PairedComparison compared = pinnquad::compare_paired(pairs.first, pairs.second);
        entry[figure]["ratio"] = 1 + compared.relative_difference;
        entry[figure]["wins"] = compared.wins;
        entry[figure]["pairs"] = compared.pairs;
        entry[figure]["p_value"] = compared.p_value;
      }
    }
  }
  return result;
}

/// Columns of the tables: title, figure, factor, decimals; with axes the worst of the three.
struct BeyondColumn {
  const char* title;
  const char* figure;
  bool has_axes;
  bool least;  ///< of the axes the least counts, else the greatest
  double times;
  int decimals;
};

/// A table: its columns, and which figure is compared with the yardstick's.
struct BeyondTable {
  const char* compared;
  std::vector<BeyondColumn> columns;
};

inline const std::array<BeyondTable, 2>& beyond_tables() {
  static const std::array<BeyondTable, 2> tables = {
      {{"mean_absolute_error",
        {{"error, 1e-3", "mean_absolute_error", false, false, 1e3, 2},
         {"wrong signs, %", "wrong_derivative_share", true, false, 100, 2},
         {"least derivative", "least_derivative_over_nominal", true, true, 1, 2},
         {"proven, %", "proven", false, false, 100, 0},
         {"slope error, %", "slope_error", true, false, 100, 1},
         {"pairs, %", "pair_violations", true, false, 100, 1},
         {"network kept, %", "residual_kept", false, false, 100, 0},
         {"training, s", "training_s", false, false, 1, 1}}},
       {"eight_rmse_m",
        {{"eight, cm", "eight_rmse_m", false, false, 100, 2},
         {"declined, %", "eight_declined_share", false, false, 100, 1},
         {"yaw eight, cm", "yaw_eight_rmse_m", false, false, 100, 2},
         {"declined, %", "yaw_eight_declined_share", false, false, 100, 1},
         {"circle, cm", "circle_rmse_m", false, false, 100, 2},
         {"declined, %", "circle_declined_share", false, false, 100, 1}}}}};
  return tables;
}

inline std::string beyond_text(const nlohmann::json& entry, const BeyondColumn& column) {
  double shown = pinnquad::not_a_number;
  const auto take = [&](const std::string& name) {
    const nlohmann::json& mean = entry.at(name).at("mean");
    const double value = mean.is_number() ? mean.get<double>() : pinnquad::not_a_number;
    if (!(column.least ? shown <= value : shown >= value)) shown = value;
  };
  if (!column.has_axes) take(column.figure);
  for (const char* axis : programs::axis_names) {
    if (column.has_axes) take(std::string(column.figure) + "_" + axis);
  }
  if (!std::isfinite(shown)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", column.decimals, column.times * shown);
  return text;
}

/// A line of a table: its cells, the model's name first.
inline std::vector<std::string> beyond_line(const BeyondTable& table, const std::string& model,
                                            const nlohmann::json& entry) {
  std::vector<std::string> cells = {model};
  for (const BeyondColumn& column : table.columns) cells.push_back(beyond_text(entry, column));
  char text[48];
  const auto add = [&](auto... values) {
    std::snprintf(text, sizeof text, values...);
    cells.emplace_back(text);
  };
  const nlohmann::json& compared = entry.at(table.compared);
  if (compared.contains("ratio")) {
    add("%.3f", compared["ratio"].get<double>());
    add("%d/%d", compared["wins"].get<int>(), compared["pairs"].get<int>());
    add("%.2g", compared["p_value"].get<double>());
  } else {
    cells.insert(cells.end(), 3, "-");
  }
  return cells;
}

inline std::vector<std::string> beyond_titles(const BeyondTable& table) {
  std::vector<std::string> titles = {"model"};
  for (const BeyondColumn& column : table.columns) titles.emplace_back(column.title);
  titles.insert(titles.end(), {"ratio", "better", "p"});
  return titles;
}

/// Whether a condition's models have the figure that a table compares: not the closed loop's where none was flown.
inline bool has_table(const BeyondTable& table, const nlohmann::json& models) {
  return std::any_of(models.begin(), models.end(), [&](const nlohmann::json& entry) {
    const nlohmann::json& mean = entry.at(table.compared).at("mean");
    return mean.is_number() && std::isfinite(mean.get<double>());
  });
}

}  // namespace study
