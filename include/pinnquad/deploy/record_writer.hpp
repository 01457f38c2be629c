// SPDX-License-Identifier: MIT
// The records of an exported model, found once, for the header (exported/model_records.hpp) and for the block
// (exported/block_records.hpp).
#pragma once

#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "pinnquad/data/row_set.hpp"
#include "pinnquad/deploy/literal.hpp"
#include "pinnquad/deploy/provenance.hpp"
#include "pinnquad/exported/block_records.hpp"
#include "pinnquad/exported/contents_hash.hpp"

namespace pinnquad::detail {

/// A description as a text (model/description.hpp).
struct DescriptionText {
  std::string text;
  void add(std::string_view piece) { text += piece; }
  void add(int number) { text += std::to_string(number); }
};
template <class T>
std::string description_text() {
  DescriptionText sink;
  describe<T>(sink);
  return sink.text;
}

/// The records of a model, as header and block state them.
struct WrittenRecords {
  CommandMeaning command_meaning = CommandMeaning::thrust;
  double command_lower = 0, command_upper = 1, sample_period_s = 0, lag_removed_s = 0;
  AllocationMatrix<double> allocation{};
  std::optional<std::uint32_t> judged{};  ///< bits of Judged
  std::optional<std::array<TorqueSigns, rotor_count>> slope_signs{};
  std::optional<ResidualRange> residual_range{};
  std::optional<DistanceStatistics> distance{};
  std::uint32_t window_taps = 1;  ///< 1: the present alone
  bool causal = true;
  std::vector<std::string> column_names, column_units;
  std::string answer;  ///< description of what the parameters are of
  std::string base;    ///< description of the outputs' base; empty: none
};

/// Those that the model's types say.
template <class Network, class Features, class Outputs>
WrittenRecords records_of_types() {
  using Window = WindowOf<Features>;
  const auto& names = extra_column_names<Features>;
  const auto& units = extra_column_units<Features>;
  WrittenRecords records;
  records.window_taps = static_cast<std::uint32_t>(Window::taps);
  records.causal = Window::causal;
  records.column_names.assign(names.begin(), names.end());
  records.column_units.assign(units.begin(), units.end());
  records.answer = description_text<Network>();
  records.base = description_text<typename BaseOf<Outputs>::type>();
  return records;
}

/// Of a training. Throws std::invalid_argument for a range that is none, a time beyond 0 to 4 s, another period than the
/// window's, and for statistics of another length than the model's, or that are not finite.
template <class Network, class Features, class Outputs>
WrittenRecords records_of_training(const Provenance& from, const Airframe<double>& airframe) {
  const auto refuse = [](const std::string& what) { throw std::invalid_argument("export: " + what); };
  WrittenRecords records = records_of_types<Network, Features, Outputs>();
  records.command_meaning = from.command_meaning ? *from.command_meaning : command_meaning_of(airframe);
  records.command_lower = from.command_lower;
  records.command_upper = from.command_upper;
  if (!is_finite(from.command_lower) || !is_finite(from.command_upper) || !(from.command_lower <= from.command_upper)) {
    refuse("the range of the commands is none");
  }
  if (!is_clock_time(from.sample_period_s)) refuse("the sample period is not one of 0 to 4 s");
  if (!is_clock_time(from.lag_removed_s)) refuse("the lag removed is not one of 0 to 4 s");
  constexpr double window_s = WindowOf<Features>::period_s;
  if (window_s > 0 && from.sample_period_s > 0 && !same_period(from.sample_period_s, window_s)) {
    refuse("the sample period is not that of the features' window");
  }
  records.sample_period_s = window_s > 0 ? window_s : from.sample_period_s;
  records.lag_removed_s = from.lag_removed_s;
  records.allocation = allocation(airframe);
  if (from.verdict) {
    records.judged = Judged::bits(from.verdict->worse_than_mean(), from.verdict->beats_linear_regression());
  }
  records.slope_signs = from.slope_signs;
  if (from.residual_range) {
    constexpr auto outputs = static_cast<std::size_t>(OutputMap<Outputs>::size);
    const ResidualRange& range = *from.residual_range;
    if (range.lower.size() != outputs || range.upper.size() != outputs) {
      refuse("the range of a residual is not one of bounds for every output");
    }
    require_finite(range.lower, "the lower bounds of the residual");
    require_finite(range.upper, "the upper bounds of the residual");
    for (std::size_t i = 0; i < outputs; ++i) {
      if (!(range.lower[i] <= range.upper[i])) refuse("a lower bound of the residual lies above the upper one");
    }
    records.residual_range = range;
  }
  if (from.distance) {
    constexpr auto size = static_cast<std::size_t>(Features::size);
    const DistanceStatistics& distance = *from.distance;
    if (distance.mean.size() != size || distance.inverse_cholesky.size() != triangle(size)) {
      refuse("the statistics of a distance are not those of " + std::to_string(size) + " features");
    }
    require_finite(distance.mean, "the means of the distance");
    require_finite(distance.inverse_cholesky, "the triangle of the distance");
    if (!is_finite(distance.limit) || !(distance.limit > 0)) refuse("the limit of the distance is no number above 0");
    records.distance = distance;
  }
  return records;
}

template <class Array>
std::vector<double> as_doubles(const Array& values) {
  return std::vector<double>(values.begin(), values.end());
}

/// Of an exported header, of whatever format.
template <class M>
WrittenRecords records_of_header() {
  WrittenRecords records = records_of_types<typename M::Network, typename M::Features, typename M::Outputs>();
  records.allocation = allocation(airframe_value<typename M::Vehicle, double>());
  records.command_meaning = header_command_meaning<M>();
  records.sample_period_s = header_period_s<M>();
  if constexpr (is_detected<RecordsOf, M>) {
    records.command_lower = M::command_lower;
    records.command_upper = M::command_upper;
    records.lag_removed_s = M::lag_removed_s;
  }
  if constexpr (is_detected<StatedVerdictOf, M>) {
    records.judged = Judged::bits(M::worse_than_mean, M::beats_linear_regression);
  }
  if constexpr (is_detected<SlopeSignsOf, M>) records.slope_signs = M::slope_signs;
  if constexpr (is_detected<ResidualRangeOf, M>) {
    records.residual_range = ResidualRange{as_doubles(M::residual_lower), as_doubles(M::residual_upper)};
  }
  if constexpr (is_detected<DistanceStatisticsOf, M>) {
    records.distance = DistanceStatistics{as_doubles(M::distance_mean), as_doubles(M::distance_inverse_cholesky),
                                          static_cast<double>(M::distance_limit)};
  }
  return records;
}

/// The same numbers in a model's Scalar.
template <class Scalar>
std::vector<Scalar> rounded(const std::vector<double>& values) {
  std::vector<Scalar> result;
  for (const double value : values) result.push_back(static_cast<Scalar>(value));
  return result;
}

/// The constants of a struct, written one after the other, and the hash over those that count (exported/contents_hash.hpp).
class ConstantWriter {
 public:
  explicit ConstantWriter(std::ostream& out) : out_(out) {}

  std::uint64_t contents_hash() const { return sum_; }
  /// Takes into the hash a value that is no constant.
  template <class Value>
  void count(std::string_view name, const Value& value) {
    if (!is_hashed(name)) return;
    ConstantHash hash(name);
    add(hash, value);
    sum_ += hash.value();
  }

  /// `written`: the value as C++ text.
  template <class Value>
  void constant(const char* type, const char* name, const std::string& written, const Value& value) {
    out_ << "  static constexpr " << type << ' ' << name << " = " << written << ";\n";
    count(name, value);
  }
  void truth(const char* name, bool value) { constant("bool", name, value ? "true" : "false", value); }
  void number(const char* name, int value) { constant("int", name, std::to_string(value), value); }
  void number(const char* name, double value) { constant("double", name, literal(value), value); }
  void text(const char* name, const std::string& value) { constant("const char*", name, quoted(value), value); }
  template <class Values>
  void list(const std::string& type, const char* name, const Values& values) {
    out_ << "  static constexpr std::array<" << type << ", " << values.size() << "> " << name << " = ";
    if (values.size() == 0) {
      out_ << "{};\n";
    } else {
      out_ << '{';
      write_braced(out_, values, "  ");
      out_ << "};\n";
    }
    count(name, values);
  }
  template <class Rows>
  void table(const std::string& type, const char* name, const Rows& rows) {
    out_ << "  static constexpr std::array<std::array<" << type << ", " << rows[0].size() << ">, " << rows.size()
         << "> " << name << " = {{";
    for (std::size_t i = 0; i < rows.size(); ++i) {
      out_ << (i == 0 ? "\n    {" : ",\n    {");
      write_braced(out_, rows[i], "    ");
      out_ << '}';
    }
    out_ << "}};\n";
    count(name, rows);
  }
  template <class Scalar, int Size>
  void scaler(const std::string& type, const char* name, const Scaler<Scalar, Size>& value) {
    out_ << "  static constexpr pinnquad::Scaler<" << type << ", " << Size << "> " << name << " = {{";
    write_braced(out_, value.mean, "  ");
    out_ << "}, {";
    write_braced(out_, value.standard_deviation, "  ");
    out_ << "}};\n";
    count(name, value);
  }

 private:
  template <class Value>
  static void add(ConstantHash& hash, const Value& value) {
    hash.add(value);
  }
  static void add(ConstantHash& hash, const char* text) { hash.add(printable(text)); }
  static void add(ConstantHash& hash, const std::string& text) { hash.add(printable(text)); }
  template <class Value>
  static void add(ConstantHash& hash, const std::vector<Value>& values) {
    for (const Value& value : values) add(hash, value);
  }
  template <class Value, std::size_t Size>
  static void add(ConstantHash& hash, const std::array<Value, Size>& values) {
    for (const Value& value : values) add(hash, value);
  }

  std::ostream& out_;
  std::uint64_t sum_ = 0;
};

/// Writes the constants of format 3 into a struct, whose texts around them are `out`'s.
template <class Scalar>
void write_header_records(std::ostream& out, ConstantWriter& write, const WrittenRecords& records) {
  const std::string scalar = std::is_same_v<Scalar, float> ? "float" : "double";
  out << "\n  // records: a reader that does not know one of them must not fly the model "
         "(exported/model_records.hpp)\n";
  std::vector<std::string> names;
  for (const std::string_view record : known_records) names.emplace_back(record);
  write.list("const char*", "records", names);
  write.text("answer", records.answer);
  write.constant("auto", "command_meaning",
                 std::string("pinnquad::CommandMeaning::") + to_string(records.command_meaning),
                 records.command_meaning);
  write.number("command_lower", records.command_lower);
  write.number("command_upper", records.command_upper);
  write.number("sample_period_s", records.sample_period_s);
  write.number("lag_removed_s", records.lag_removed_s);
  write.number("window_taps", static_cast<int>(records.window_taps));
  write.truth("causal", records.causal);
  write.list("const char*", "column_names", records.column_names);
  write.list("const char*", "column_units", records.column_units);
  out << "  // thrust [N], roll, pitch and yaw torque [N m] of each rotor at full command, rated density\n";
  write.table("double", "allocation", records.allocation);
  write.text("base", records.base);
  if (records.slope_signs) write.table("int", "slope_signs", *records.slope_signs);
  if (records.residual_range) {
    write.list(scalar, "residual_lower", rounded<Scalar>(records.residual_range->lower));
    write.list(scalar, "residual_upper", rounded<Scalar>(records.residual_range->upper));
  }
  if (records.distance) {
    write.list(scalar, "distance_mean", rounded<Scalar>(records.distance->mean));
    write.list(scalar, "distance_inverse_cholesky", rounded<Scalar>(records.distance->inverse_cholesky));
    const auto limit = static_cast<Scalar>(records.distance->limit);
    write.constant(scalar.c_str(), "distance_limit", literal(limit), limit);
  }
}

}  // namespace pinnquad::detail
