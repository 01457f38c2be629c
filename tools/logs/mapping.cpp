// SPDX-License-Identifier: MIT
#include "logs/mapping.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "logs/log_parts.hpp"
#include "logs/nearest_names.hpp"
#include "logs/toml_table.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/io/decimal.hpp"

namespace pinnquad::logs {
namespace {

struct Unit {
  std::string_view name;
  double in_si;
};

constexpr double g_m_s2 = 9.80665;  // standard gravity: what "g" means in a log
constexpr double degree = 1 / degrees_per_radian;

/// The units of a dimension, in the order in which a message offers them.
std::vector<Unit> units_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::time: return {{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}};
    case Dimension::angle:
      return {{"rad", 1}, {"deg", degree}, {"ddeg", 0.1 * degree}, {"cdeg", 0.01 * degree}, {"mrad", 1e-3}};
    case Dimension::turning:
      return {{"rad/s", 1}, {"deg/s", degree}, {"ddeg/s", 0.1 * degree}, {"cdeg/s", 0.01 * degree}, {"mrad/s", 1e-3}};
    case Dimension::angular_acceleration: return {{"rad/s^2", 1}, {"deg/s^2", degree}};
    case Dimension::acceleration:
      return {{"m/s^2", 1}, {"g", g_m_s2}, {"mg", 1e-3 * g_m_s2}, {"cm/s^2", 1e-2}, {"mm/s^2", 1e-3}};
    case Dimension::speed: return {{"m/s", 1}, {"mm/s", 1e-3}, {"cm/s", 1e-2}, {"km/h", 1 / 3.6}};
    case Dimension::length: return {{"m", 1}, {"mm", 1e-3}, {"cm", 1e-2}, {"ft", 0.3048}};
    case Dimension::rotor_speed: return {{"rev/s", 1}, {"rpm", 1.0 / 60}, {"rad/s", 0.15915494309189535}};
    case Dimension::force: return {{"N", 1}, {"mN", 1e-3}};
    case Dimension::torque: return {{"N m", 1}, {"mN m", 1e-3}};
    case Dimension::none: break;
  }
  return {};
}

/// Other spellings, as logs have them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 12> spellings = {{{"m/s/s", "m/s^2"},
                                                                                      {"m/s2", "m/s^2"},
                                                                                      {"degree", "deg"},
                                                                                      {"degrees", "deg"},
                                                                                      {"radians", "rad"},
                                                                                      {"dps", "deg/s"},
                                                                                      {"rad/s/s", "rad/s^2"},
                                                                                      {"deg/s/s", "deg/s^2"},
                                                                                      {"rad/s2", "rad/s^2"},
                                                                                      {"mps", "m/s"},
                                                                                      {"Nm", "N m"},
                                                                                      {"sec", "s"}}};

/// "\"rad\" or \"deg\"": for messages.
std::string unit_names(Dimension dimension) {
  std::string names;
  for (const Unit& unit : units_of(dimension)) {
    names += (names.empty() ? "\"" : ", \"") + std::string(unit.name) + "\"";
  }
  return names;
}

constexpr const char* mapping_key = "a key of a mapping";
constexpr const char* a_name = "a name in quotation marks";

MappingPlace place_of(const toml::node& node) { return {node.source().begin.line, node.source().begin.column}; }

/// The frames of the whole mapping, which a source may say otherwise.
struct Frames {
  WorldFrame world = WorldFrame::ned;
  BodyFrame body = BodyFrame::frd;
};

Frames frames_of(TomlTable& table, const Frames& otherwise) {
  return {table.choice("world", {"ned", "enu"}, otherwise.world), table.choice("body", {"frd", "flu"}, otherwise.body)};
}

/// As the number of a mapping: 0.1, or "1/2048", "1/acc_1G", "acc_1G", of which a name is one of the log's parameters.
MappedNumber mapped_number(TomlTable& table, const char* key, double otherwise) {
  MappedNumber number{otherwise, {}, false};
  const toml::node* node = table.optional(key);
  if (!node) return number;
  if (!node->is_string()) return {table.as_number(*node, of_either_sign), {}, false};
  std::string name = table.as_text(*node, a_name);
  number.divides = name.rfind("1/", 0) == 0;
  if (number.divides) name.erase(0, 2);
  if (parse_number(name, number.value)) {
    if (number.divides) number.value = 1 / number.value;
    if (std::isfinite(number.value)) return {number.value, {}, false};
  }
  if (name.empty() || name != printable(name)) {
    table.refuse(*node, "a number, or the name of a parameter that the log has", described(*node));
  }
  number.parameter = name;
  return number;
}

/// `scale` and `offset`, which any quantity may have.
void read_scale(TomlTable& table, Source& source) {
  source.scale = mapped_number(table, "scale", 1);
  source.offset = table.number("offset", of_either_sign, 0);
  if (source.scale.parameter.empty() && !(std::abs(source.scale.value) > 0)) {
    const toml::node& node = table.required("scale", "a number");
    table.refuse(node, "a scale other than 0", described(node));
  }
}

double unit_of(TomlTable& table, const char* key, Dimension dimension) {
  const toml::node* node = table.optional(key);
  if (!node) return 1;
  const std::string expected = "a unit: " + unit_names(dimension);
  const std::optional<double> in_si = unit_in_si(dimension, table.as_text(*node, expected));
  if (!in_si) table.refuse(*node, expected, described(*node));
  return *in_si;
}

double time_unit_of(TomlTable& table, const char* key, double otherwise) {
  return table.optional(key) ? unit_of(table, key, Dimension::time) : otherwise;
}

/// The unit of the quantity's table.
void read_unit(TomlTable& table, Source& source, Dimension dimension) {
  source.in_si = unit_of(table, "unit", dimension);
  source.unit = table.text("unit", a_name, "");
}

/// `least` of them or more, up to `count`.
std::vector<NamedColumn> columns_of(TomlTable& table, const char* key, std::size_t count, const std::string& what,
                                    std::size_t least = 0) {
  const std::string expected = (least > 0 ? std::to_string(least) + " or " : "") + std::to_string(count) +
                               (count == 1 ? " column of " : " columns of ") + what + ", names in quotation marks";
  const toml::node& node = table.required(key, expected);
  std::vector<NamedColumn> columns;
  if (count == 1 && node.is_string()) return {{node.as_string()->get(), place_of(node)}};
  const toml::array* list = node.as_array();
  if (!list || (list->size() != count && (least == 0 || list->size() != least))) {
    table.refuse(node, expected, described(node));
  }
  for (const toml::node& name : *list) columns.push_back({table.as_text(name, a_name), place_of(name)});
  return columns;
}

NamedColumn named(TomlTable& table, const char* key) {
  const toml::node& node = table.required(key, a_name);
  return {table.as_text(node, a_name), place_of(node)};
}

std::array<MotorOrder::Corner, rotor_count> motor_order_of(TomlTable& table) {
  constexpr std::array<const char*, 4> corners = {"front_right", "rear_left", "front_left", "rear_right"};
  const std::string expected =
      "\"px4\", \"betaflight\", \"crazyflie\", or the four corners of an X quadrotor, \"front_right\" ...";
  const toml::node& node = table.required("order", expected);
  MotorOrder order;
  if (const auto* name = node.as_string()) {
    if (motor_order_named(name->get(), order) != Status::ok) {
      table.refuse(node, expected, described(node));
    }
    return order.corners;
  }
  const toml::array* list = node.as_array();
  if (!list || list->size() != rotor_count) table.refuse(node, expected, described(node));
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const std::string name = table.as_text((*list)[i], expected);
    std::size_t corner = 0;
    while (corner < corners.size() && name != corners[corner]) ++corner;
    if (corner == corners.size()) table.refuse((*list)[i], expected, described((*list)[i]));
    order.corners[i] = static_cast<MotorOrder::Corner>(corner);
  }
  if (!is_motor_order(order.corners)) table.refuse(node, "each corner once", "one of them twice");
  return order.corners;
}

void read_motors(TomlTable& table, Source& source) {
  source.corners = motor_order_of(table);
  source.numbers = table.choice("numbers", {"thrust", "signal", "speed"}, MotorNumbers::thrust);
  source.least = mapped_number(table, "least", 0);
  source.most = mapped_number(table, "most", 1);
  const bool of_log = !source.least.parameter.empty() || !source.most.parameter.empty();
  if (!of_log && !(source.most.value > source.least.value)) {
    const toml::node* node = table.optional("most");
    if (!node) node = table.optional("least");
    if (node) table.refuse(*node, "`most` above `least`", number_text(source.most.value));
  }
  if (source.numbers == MotorNumbers::speed) read_unit(table, source, Dimension::rotor_speed);
  const toml::node* curve = table.optional("thrust_curve");
  if (curve && curve->is_string()) {
    source.thrust_curve_parameter = curve->as_string()->get();
  } else if (curve) {
    source.thrust_curve = table.as_number(*curve, zero_to_one);
  }
}

void read_columns(TomlTable& table, Source& source, const QuantityFacts& facts) {
  if (facts.quantity == Quantity::attitude) {
    source.euler = table.optional("euler") != nullptr;
    source.columns = source.euler ? columns_of(table, "euler", 3, "roll, pitch and yaw")
                                  : columns_of(table, "quaternion", 4, "a quaternion", 3);
    source.without_scalar = !source.euler && source.columns.size() == 3;
    if (source.euler) {
      read_unit(table, source, facts.dimension);
      for (std::size_t i = 0; i < source.columns.size(); ++i) {
        std::string& name = source.columns[i].name;
        if (name[0] != '-') continue;
        source.euler_signs[i] = -1;
        name.erase(0, 1);
      }
    }
    if (!source.euler && !source.without_scalar) source.scalar_last = table.choice("order", {"wxyz", "xyzw"}, false);
    source.world_to_body = table.choice("direction", {"body_to_world", "world_to_body"}, false);
  } else if (facts.quantity == Quantity::torque_and_thrust) {
    source.columns = columns_of(table, "torque", 3, "torque about x, y and z");
    source.columns.push_back(columns_of(table, "thrust", 1, "thrust along z").front());
    source.thrust_topic = table.text("thrust_topic", a_name, source.topic);
    source.thrust_is_up = table.choice("thrust_is", {"down", "up"}, false);
    source.wrench = table.optional("torque_unit") != nullptr;
    if (source.wrench) {
      source.in_si = unit_of(table, "torque_unit", Dimension::torque);
      static_cast<void>(table.required("thrust_unit", "a unit: " + unit_names(Dimension::force)));
      source.thrust_in_si = unit_of(table, "thrust_unit", Dimension::force);
    } else if (const toml::node* thrust = table.optional("thrust_unit")) {
      table.refuse(*thrust, "`torque_unit` beside it", "none");
    }
  } else {
    source.columns = columns_of(table, "columns", facts.columns, facts.words);
    if (facts.quantity == Quantity::motors) read_motors(table, source);
    if (facts.dimension != Dimension::none) read_unit(table, source, facts.dimension);
  }
  read_scale(table, source);
  if (facts.quantity == Quantity::acceleration || facts.quantity == Quantity::velocity) {
    const Axes usual = facts.quantity == Quantity::velocity ? Axes::world : Axes::body;
    source.axes = table.choice("axes", {"body", "world"}, usual);
  }
}

/// Keys of every source.
void read_place(TomlTable& table, const toml::table& node, Source& source) {
  constexpr double most_instances = 255;
  source.place = place_of(node);
  source.topic = table.text("topic", a_name, "");
  source.instance = static_cast<int>(table.number("instance", {0, most_instances, "a value from 0 to 255"}, 0));
  source.optional = table.truth("optional", false);
  source.held = table.truth("held", false);
  source.time_column = table.text("time", a_name, "");
  source.time_in_s = time_unit_of(table, "time_unit", source.time_in_s);
}

Source source_of(const std::string& path, const toml::table& node, const QuantityFacts& facts, const Frames& frames) {
  TomlTable table(path, node, mapping_key);
  Source source;
  source.quantity = facts.quantity;
  read_place(table, node, source);
  const Frames own = frames_of(table, frames);
  source.world = own.world;
  source.body = own.body;
  read_columns(table, source, facts);
  if (source.euler && node.contains("world") != node.contains("body")) {  // level is 0, 0: both have z up, or down
    if (node.contains("world")) source.body = source.world == WorldFrame::enu ? BodyFrame::flu : BodyFrame::frd;
    if (node.contains("body")) source.world = source.body == BodyFrame::flu ? WorldFrame::enu : WorldFrame::ned;
  }
  table.require_no_more();
  return source;
}

/// A table, or the several of an array of them.
std::vector<const toml::table*> tables_of(TomlTable& root, const char* key) {
  const toml::node* node = root.optional(key);
  if (!node) return {};
  if (const toml::table* one = node->as_table()) return {one};
  const toml::array* list = node->as_array();
  const std::string expected = std::string("a table [") + key + "], or several [[" + key + "]]";
  if (!list || list->empty() || !list->is_homogeneous<toml::table>()) root.refuse(*node, expected, described(*node));
  std::vector<const toml::table*> tables;
  for (const toml::node& each : *list) tables.push_back(each.as_table());
  return tables;
}

/// Calls `read(table)` for a table that may be missing.
template <class Read>
void with_table(const std::string& path, TomlTable& root, const char* key, const Read& read) {
  const toml::node* node = root.optional(key);
  if (!node) return;
  if (!node->is_table()) root.refuse(*node, std::string("a table [") + key + "]", described(*node));
  TomlTable table(path, *node->as_table(), mapping_key);
  read(table);
  table.require_no_more();
}

void read_extras(const std::string& path, TomlTable& root, Mapping& mapping) {
  for (const toml::table* node : tables_of(root, "extra")) {
    TomlTable table(path, *node, mapping_key);
    ExtraSource extra;
    extra.source.quantity = Quantity::extra;
    read_place(table, *node, extra.source);
    extra.name = table.text("name", a_name);
    extra.unit = table.text("unit", a_name);
    const auto plain = [](const std::string& text) {
      return !text.empty() && text.size() < 64 && text == printable(text) &&
             text.find_first_of("[]\"',\\") == std::string::npos;
    };
    for (const char* key : {"name", "unit"}) {
      const toml::node& said = table.required(key, a_name);
      if (!plain(said.as_string()->get()))
        table.refuse(said, "plain text without brackets, commas and quotes", described(said));
    }
    for (const std::string_view taken : sample_field_names) {
      if (extra.name == taken)
        table.refuse(table.required("name", a_name), "a name that no column of every flight has",
                     "\"" + extra.name + "\"");
    }
    for (const ExtraSource& other : mapping.extras) {
      if (other.name == extra.name && other.unit != extra.unit) {
        table.refuse(table.required("unit", a_name), "the unit \"" + other.unit + "\" as before",
                     "\"" + extra.unit + "\"");
      }
    }
    extra.source.columns = columns_of(table, "column", 1, extra.name);
    extra.source.unit = extra.unit;
    read_scale(table, extra.source);
    table.require_no_more();
    mapping.extras.push_back(std::move(extra));
  }
}

void read_rules(const std::string& path, TomlTable& root, Mapping& mapping) {
  with_table(path, root, "time", [&](TomlTable& table) {
    const toml::node* scale = table.optional("scale");
    if (!scale || table.optional("column")) {  // topics have clocks of their own, which may run wrong too
      mapping.time_column = named(table, "column");
      mapping.time_in_s = unit_of(table, "unit", Dimension::time);
    }
    if (scale) mapping.time_scale = table.as_number(*scale, {0.5, 2, "a value from 0.5 to 2"});
  });
  with_table(path, root, "flights", [&](TomlTable& table) {
    if (table.optional("column")) mapping.flight_column = named(table, "column");
    if (table.optional("trajectory_column")) mapping.trajectory_column = named(table, "trajectory_column");
    mapping.trajectory = table.text("trajectory", "a pattern such as \"*_(*)_*\"", "");
    if (!mapping.trajectory.empty() && !is_name_pattern(mapping.trajectory)) {
      const toml::node& node = table.required("trajectory", "");
      table.refuse(node, "a pattern with one pair of brackets and at most six stars, such as \"*_(*)_*\"",
                   described(node));
    }
    mapping.split_gap_s = table.number("split_gap_s", above_zero, mapping.split_gap_s);
  });
  with_table(path, root, "ground", [&](TomlTable& table) {
    const toml::node* height = table.optional("height_m");
    mapping.ground_from_log = height && height->is_string() && height->as_string()->get() == "before_flight";
    if (height && !height->is_number() && !mapping.ground_from_log) {
      table.refuse(*height, "a number or \"before_flight\"", described(*height));
    }
    if (height && height->is_number()) mapping.ground_m = table.as_number(*height, of_either_sign);
    mapping.least_height_m = table.number("least_height_m", from_zero, mapping.least_height_m);
    mapping.ground_by_contact = table.truth("by_contact", false);
  });
  with_table(path, root, "commands", [&](TomlTable& table) {
    mapping.lowest_command = table.number("lowest", zero_to_one, mapping.lowest_command);
    mapping.highest_command = table.number("highest", zero_to_one, mapping.highest_command);
    mapping.idle_below = table.number("idle_below", of_either_sign, mapping.idle_below);
    if (const toml::node* lag = table.optional("lag_s")) {
      mapping.lag_s = table.as_number(*lag, {-1, 1, "a value from -1 to 1"});
    }
  });
}

Mapping mapping_of(const toml::table& tables, const std::string& path) {
  TomlTable root(path, tables, mapping_key);
  Mapping mapping;
  mapping.file = path;
  mapping.name = root.text("name", a_name, path);
  mapping.about = root.text("about", "a text", "");
  mapping.airframe = root.text("airframe", a_name, "");
  mapping.least_rate_hz = root.number("least_rate_hz", from_zero, 0);
  const Frames frames = frames_of(root, {});
  read_rules(path, root, mapping);
  for (const QuantityFacts& facts : quantities) {
    for (const toml::table* node : tables_of(root, facts.key)) {
      mapping.sources.push_back(source_of(path, *node, facts, frames));
    }
  }
  read_extras(path, root, mapping);
  root.require_no_more();
  const auto has = [&](std::initializer_list<Quantity> any) {
    for (const Source& source : mapping.sources) {
      for (const Quantity quantity : any) {
        if (source.quantity == quantity) return true;
      }
    }
    return false;
  };
  const auto need = [&](std::initializer_list<Quantity> any, const char* expected) {
    if (!has(any)) throw InputError(path, 1, 1, expected, "none");
  };
  need({Quantity::attitude}, "a table [attitude]");
  need({Quantity::body_rates}, "a table [body_rates]");
  need({Quantity::motors, Quantity::torque_and_thrust}, "a table [motors] or [torque_and_thrust]");
  need({Quantity::specific_force, Quantity::acceleration, Quantity::velocity, Quantity::position},
       "a table [specific_force], [acceleration], [velocity] or [position]");
  return mapping;
}

}  // namespace

std::optional<double> unit_in_si(Dimension dimension, const std::string& name) {
  const auto same =
      std::find_if(spellings.begin(), spellings.end(), [&](const auto& one) { return one.first == name; });
  for (const Unit& unit : units_of(dimension)) {
    if (unit.name == (same == spellings.end() ? std::string_view(name) : same->second)) return unit.in_si;
  }
  return std::nullopt;
}

Mapping parse_mapping(const std::string& text, const std::string& path) {
  return mapping_of(parse_toml(text, path), path);
}

Mapping read_mapping_file(const std::string& path) { return mapping_of(read_toml_file(path, "a mapping"), path); }

}  // namespace pinnquad::logs
