// SPDX-License-Identifier: MIT
// The summary of a replay, as its user reads it first: the share of each answerer, the longest stretch without the
// model, the first events with their reasons, where commands differ most; and the same as JSON.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/in_columns.hpp"
#include "command_line/in_words.hpp"
#include "command_line/listed.hpp"
#include "model/replayed_row.hpp"
#include "pinnquad/io/file_error.hpp"

namespace programs {

inline constexpr std::size_t events_shown = 10;

/// Rows without the model's commands, one after the other.
struct ReplayStretch {
  const ReplayedRow* first = nullptr;
  std::size_t rows = 0;
  double duration_s = 0;  ///< to the row behind it
};

/// How often a feature was the one furthest outside the envelope.
struct OutsideCount {
  std::size_t rows = 0;
  double largest_excess = 0;  ///< half-widths of its range
};

/// A row whose state is another than the one's before, and for how long it stays so.
struct ReplayEvent {
  const ReplayedRow* row = nullptr;
  double duration_s = 0;
};

struct ReplaySummary {
  std::map<std::string, std::size_t> answerers;  ///< rows by who answered
  std::map<std::string, std::size_t> statuses, causes, reactions;
  ReplayStretch longest;
  std::map<std::string, OutsideCount> outside;  ///< by feature
  std::vector<ReplayEvent> events;              ///< the first row of a flight among them
  const ReplayedRow* furthest = nullptr;        ///< whose commands differ most from the log's
  double largest_difference = 0;
  std::size_t furthest_rotor = 0;
  double mean_difference = 0;
  std::size_t differing = 0;  ///< of a core: ticks that differ from what was logged
  const ReplayedRow* first_differing = nullptr;
};

inline ReplaySummary summary_of(const Replayed& replayed) {
  ReplaySummary result;
  double sum = 0;
  std::size_t compared = 0;
  ReplayStretch current;
  const ReplayedRow* before = nullptr;
  const auto end_stretch = [&](double time_s) {
    if (current.rows > 0) current.duration_s = time_s - current.first->time_s;
    const ReplayStretch& longest = result.longest;
    if (current.rows > 0 && (longest.rows == 0 || current.duration_s > longest.duration_s)) result.longest = current;
    current = {};
  };
  for (const ReplayedRow& row : replayed.rows) {
    const bool begins = before == nullptr || before->flight != row.flight;
    if (begins && before != nullptr) end_stretch(before->time_s);
    ++result.answerers[to_string(row.answerer)];
    ++result.statuses[pinnquad::to_string(row.status)];
    ++result.causes[pinnquad::to_string(row.cause)];
    if (!row.reaction.empty()) ++result.reactions[row.reaction];
    if (begins || row.state != before->state) {
      if (!result.events.empty()) {
        ReplayEvent& last = result.events.back();
        last.duration_s = (begins ? before->time_s : row.time_s) - last.row->time_s;
      }
      result.events.push_back({&row});
    }
    if (!row.feature.empty()) {
      OutsideCount& count = result.outside[row.feature];
      ++count.rows;
      count.largest_excess = std::max(count.largest_excess, row.excess);
    }
    if (row.answerer == Answerer::model || row.answerer == Answerer::learner || row.answerer == Answerer::not_asked) {
      end_stretch(row.time_s);
    } else if (current.rows++ == 0) {
      current.first = &row;
    }
    std::size_t rotor = 0;
    const double difference = largest_difference(row.commands, row.logged, rotor);
    if (!std::isnan(difference)) {
      sum += difference;
      ++compared;
      if (result.furthest == nullptr || difference > result.largest_difference) {
        result.furthest = &row;
        result.largest_difference = difference;
        result.furthest_rotor = rotor;
      }
    }
    if (!row.differs.empty()) {
      ++result.differing;
      if (result.first_differing == nullptr) result.first_differing = &row;
    }
    before = &row;
  }
  if (before != nullptr) {
    end_stretch(before->time_s);
    result.events.back().duration_s = before->time_s - result.events.back().row->time_s;
  }
  result.mean_difference = compared > 0 ? sum / static_cast<double>(compared) : 0;
  return result;
}

namespace detail {

inline std::string place_of(const Replayed& replayed, const ReplayedRow& row) {
  std::string place = in_words("%.3f s (%s %zu)", row.time_s, replayed.of_core ? "tick" : "row", row.row);
  if (replayed.flights.size() > 1) place += " of " + replayed.flights[row.flight];
  return place;
}

/// "outside_envelope 12, not_finite 3", the most frequent first.
inline std::string counts_in_words(const std::map<std::string, std::size_t>& counts, const std::string& without = "") {
  std::vector<std::pair<std::string, std::size_t>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string words;
  for (const auto& [name, count] : sorted) {
    if (name != without) add_to_list(words, name + " " + std::to_string(count));
  }
  return words;
}

inline std::size_t count_of(const std::map<std::string, std::size_t>& counts, const std::string& name) {
  const auto found = counts.find(name);
  return found == counts.end() ? 0 : found->second;
}

}  // namespace detail

inline void print_summary(const Replayed& replayed, const ReplaySummary& summary) {
  using pinnquad::printable;
  const std::size_t rows = replayed.rows.size();
  const char* unit = replayed.of_core ? "ticks" : "rows";
  std::printf("%-11s %zu, from %.3f to %.3f s\n", unit, rows, replayed.rows.front().time_s,
              replayed.rows.back().time_s);
  if (replayed.of_core) std::printf("reactions   %s\n", detail::counts_in_words(summary.reactions).c_str());
  const std::pair<Answerer, const char*> lines[] = {{Answerer::model, "model"},
                                                    {Answerer::learner, "learner"},
                                                    {Answerer::analytic_inverse, "fell back"},
                                                    {Answerer::nobody, "no answer"},
                                                    {Answerer::not_asked, "not asked"}};
  for (const auto& [answerer, name] : lines) {
    const std::size_t count = detail::count_of(summary.answerers, to_string(answerer));
    if (count == 0 && (answerer == Answerer::not_asked || answerer == Answerer::learner)) continue;
    std::printf("%-11s %zu (%.1f %%)\n", name, count, 100.0 * static_cast<double>(count) / static_cast<double>(rows));
  }
  const std::string causes = detail::counts_in_words(summary.causes, "ok");
  if (!causes.empty()) print_entry("because", causes);
  if (!summary.outside.empty()) {
    std::map<std::string, std::size_t> rows_of;
    for (const auto& [feature, count] : summary.outside) rows_of[feature] = count.rows;
    print_entry("outside", detail::counts_in_words(rows_of));
  }
  if (summary.longest.rows > 0) {
    std::printf("longest     %.3f s without the model: %zu %s from %s\n", summary.longest.duration_s,
                summary.longest.rows, unit, detail::place_of(replayed, *summary.longest.first).c_str());
  }
  if (summary.furthest != nullptr && !(summary.largest_difference > 0)) {
    std::printf("commands    equal to the log's, bit for bit\n");
  } else if (summary.furthest != nullptr) {
    const auto i = summary.furthest_rotor;
    print_entry("commands",
                in_words("largest difference from the log's %.2g: u%zu %.4f, logged %.4f, at %s; mean of the largest "
                         "per %s %.2g",
                         summary.largest_difference, i + 1, summary.furthest->commands[i], summary.furthest->logged[i],
                         detail::place_of(replayed, *summary.furthest).c_str(), replayed.of_core ? "tick" : "row",
                         summary.mean_difference));
  }
  std::printf("events      %zu%s\n", summary.events.size(),
              summary.events.size() > events_shown ? ", the first ones (--out has every row):" : "");
  for (std::size_t i = 0; i < std::min(summary.events.size(), events_shown); ++i) {
    const ReplayedRow& row = *summary.events[i].row;
    std::printf("  %10.3f s, %s  %s%s%s\n", row.time_s, in_words("%.3f s", summary.events[i].duration_s).c_str(),
                printable(row.state).c_str(), row.reason.empty() ? "" : ": ", printable(row.reason).c_str());
  }
  for (const std::string& note : replayed.notes) print_entry("note", printable(note));
  if (!replayed.of_core) return;
  if (replayed.at_the_edge > 0) {
    std::printf("note        %zu ticks differ by rounding alone: a feature on the border of the envelope\n",
                replayed.at_the_edge);
  }
  if (replayed.compared < rows) {
    std::printf("note        %zu ticks not compared: behind gaps, where the core's past is not known\n",
                rows - replayed.compared);
  }
  if (replayed.compared == 0) {
    std::printf("NOTHING     was compared with the log\n");
  } else if (summary.differing == 0) {
    std::printf("same        as logged, in all %zu ticks compared\n", replayed.compared);
  } else {
    std::printf("DIFFERS     from what was logged in %zu of %zu ticks, first at %s: %s\n", summary.differing,
                replayed.compared, detail::place_of(replayed, *summary.first_differing).c_str(),
                printable(summary.first_differing->differs).c_str());
  }
}

inline nlohmann::json finite_or_null(double value) { return std::isfinite(value) ? nlohmann::json(value) : nullptr; }

inline nlohmann::json as_json(const Replayed& replayed, const ReplaySummary& summary) {
  const auto place = [&](const ReplayedRow& row) {
    return nlohmann::json{
        {"flight", replayed.flights[row.flight]}, {replayed.of_core ? "tick" : "row", row.row}, {"time_s", row.time_s}};
  };
  nlohmann::json json = {{"rows", replayed.rows.size()},
                         {"answered_by", nlohmann::json::object()},
                         {"statuses", summary.statuses},
                         {"causes", summary.causes},
                         {"events", nlohmann::json::array()},
                         {"event_count", summary.events.size()},
                         {"longest_without_model", nullptr},
                         {"largest_difference", nullptr},
                         {"notes", replayed.notes}};
  json["outside_envelope"] = nlohmann::json::object();
  for (const auto& [feature, count] : summary.outside) {
    json["outside_envelope"][feature] = {{"rows", count.rows},
                                         {"largest_excess", finite_or_null(count.largest_excess)}};
  }
  for (const Answerer answerer :
       {Answerer::model, Answerer::learner, Answerer::analytic_inverse, Answerer::nobody, Answerer::not_asked}) {
    json["answered_by"][to_string(answerer)] = detail::count_of(summary.answerers, to_string(answerer));
  }
  for (std::size_t i = 0; i < std::min(summary.events.size(), events_shown); ++i) {
    const ReplayEvent& event = summary.events[i];
    json["events"].push_back(place(*event.row));
    json["events"].back().update(
        {{"duration_s", event.duration_s}, {"state", event.row->state}, {"reason", event.row->reason}});
  }
  if (summary.longest.rows > 0) {
    json["longest_without_model"] = place(*summary.longest.first);
    json["longest_without_model"].update({{"rows", summary.longest.rows}, {"duration_s", summary.longest.duration_s}});
  }
  if (summary.furthest != nullptr) {
    const auto i = summary.furthest_rotor;
    json["largest_difference"] = place(*summary.furthest);
    json["largest_difference"].update({{"rotor", i + 1},
                                       {"command", summary.furthest->commands[i]},
                                       {"logged", summary.furthest->logged[i]},
                                       {"difference", summary.largest_difference}});
    json["mean_difference"] = summary.mean_difference;
  }
  if (!replayed.of_core) return json;
  json["reactions"] = summary.reactions;
  json["compared"] = replayed.compared;
  json["differing"] = summary.differing;
  json["differing_by_rounding"] = replayed.at_the_edge;
  json["first_difference"] = nullptr;
  if (summary.first_differing != nullptr) {
    json["first_difference"] = place(*summary.first_differing);
    json["first_difference"]["differs"] = summary.first_differing->differs;
  }
  return json;
}

}  // namespace programs
