// SPDX-License-Identifier: MIT
// What `study beyond` found: a table per condition on the terminal, on a page and as JSON, each model beside the
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

#include "pictures/drawing.hpp"
#include "pictures/html_text.hpp"
#include "pictures/page_template.hpp"
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

/// Errors of a model and of the yardstick, pair by pair; a model without seeds stands beside each of the yardstick's.
inline std::pair<std::vector<double>, std::vector<double>> error_pairs(const BeyondCell& model, const BeyondCell& by) {
  std::pair<std::vector<double>, std::vector<double>> pairs;
  for (const auto& [seeds, figures] : by) {
    auto found = model.find(seeds);
    if (found == model.end()) found = model.find({seeds.first, 0});
    if (found == model.end()) continue;
    const double error = found->second.at("mean_absolute_error"), other = figures.at("mean_absolute_error");
    if (!std::isfinite(error - other)) continue;
    pairs.first.push_back(error);
    pairs.second.push_back(other);
  }
  return pairs;
}

/// {condition: {model: {figure: {mean, deviation, count}, ratio, wins, pairs, p_value}}}
inline nlohmann::json beyond_json(const StoredRows& stored) {
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
      const auto pairs = error_pairs(cell, by->second);
      if (pairs.first.empty() || pairs.first.size() > pinnquad::most_pairs) continue;
      const pinnquad::PairedComparison compared = pinnquad::compare_paired(pairs.first, pairs.second);
      entry["ratio"] = 1 + compared.relative_difference;
      entry["wins"] = compared.wins;
      entry["pairs"] = compared.pairs;
      entry["p_value"] = compared.p_value;
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
inline constexpr std::array<BeyondColumn, 6> beyond_columns = {
    {{"error, 1e-3", "mean_absolute_error", false, false, 1e3, 2},
     {"wrong signs, %", "wrong_derivative_share", true, false, 100, 2},
     {"least derivative", "least_derivative_over_nominal", true, true, 1, 2},
     {"slope error, %", "slope_error", true, false, 100, 1},
     {"pairs, %", "pair_violations", true, false, 100, 1},
     {"training, s", "training_s", false, false, 1, 1}}};

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
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", column.decimals, column.times * shown);
  return text;
}

/// A line of a table: its cells, the model's name first.
inline std::vector<std::string> beyond_line(const std::string& model, const nlohmann::json& entry) {
  std::vector<std::string> cells = {model};
  for (const BeyondColumn& column : beyond_columns) cells.push_back(beyond_text(entry, column));
  char text[48];
  const auto add = [&](auto... values) {
    std::snprintf(text, sizeof text, values...);
    cells.emplace_back(text);
  };
  if (entry.contains("ratio")) {
    add("%.3f", entry["ratio"].get<double>());
    add("%d/%d", entry["wins"].get<int>(), entry["pairs"].get<int>());
    add("%.2g", entry["p_value"].get<double>());
  } else {
    cells.insert(cells.end(), 3, "-");
  }
  return cells;
}

inline std::vector<std::string> beyond_titles() {
  std::vector<std::string> titles = {"model"};
  for (const BeyondColumn& column : beyond_columns) titles.emplace_back(column.title);
  titles.insert(titles.end(), {"ratio", "better", "p"});
  return titles;
}

/// Ratios of the errors as bars; a log scale would hide what is gained.
inline std::string ratio_bars(const nlohmann::json& models, const std::vector<BeyondModel>& order) {
  constexpr double width = 620, height = 20, left = 190, longest = 1.5, unit = (width - left - 60) / longest;
  std::string bars;
  double y = 4;
  for (const BeyondModel& model : order) {
    if (!models.contains(model.name) || !models[model.name].contains("ratio")) continue;
    const double ratio = models[model.name]["ratio"].get<double>();
    bars += programs::drawing::label(left - 8, y + 13, model.name, "end") +
            programs::drawing::rectangle(left, y, unit * std::min(ratio, longest), height - 6, "bar") +
            programs::drawing::label(left + unit * std::min(ratio, longest) + 5, y + 13,
                                     programs::shown::number(ratio, 2), "start");
    y += height;
  }
  bars += programs::drawing::line(left + unit, 0, left + unit, y, "one");
  return programs::drawing::svg(width, y + 4, bars, "ratios", "mean absolute error over that of the paper's network");
}

}  // namespace study
