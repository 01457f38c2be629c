// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <pinnquad/data/csv.hpp>
#include <pinnquad/data/split.hpp>
#include <string>
#include <vector>

#include "recorded_flight.hpp"
#include "support/temporary_folder.hpp"

using namespace pinnquad;
using pinnquad_test::random_flight;
using pinnquad_test::TemporaryFolder;

namespace {

const std::string header =
    "t,vdot_bx,vdot_by,vdot_bz,wdot_x,wdot_y,wdot_z,v_bx,v_by,v_bz,w_x,w_y,w_z,roll,pitch,yaw,altitude,u1,u2,u3,u4";

/// Two rows as an independent simulator recorded them.
const std::string row_1 =
    "0.050,0.0081039992,0.0017680993,-0.79444088,0.71187556,-3.2602422,0.14148764,8.537749e-05,1.8412273e-05,"
    "-0.035656471,0.017792288,-0.080160178,0.0040518781,0.00026387197,-0.0012027206,6.3046282e-05,15.877752,"
    "0.96524167,1,0.9304949,0.95474672";
const std::string row_2 =
    "0.100,0.071674583,0.015849292,-0.87404968,0.42356798,-1.7929393,0.14264864,0.0017909763,0.00039406927,"
    "-0.076029175,0.051837988,-0.23023456,0.011162658,0.0020764207,-0.0093431855,0.00043371267,15.880524,0.98590267,1,"
    "0.9482035,0.95769918";

bool same_bits(const Flight& a, const Flight& b) {
  return a.size() == b.size() && pinnquad::content_hash(a) == pinnquad::content_hash(b);
}

/// The text of the InputError that reading gives, without the folder.
std::string complaint(const TemporaryFolder& folder, const std::string& text, std::size_t minimum_rows = 1) {
  const std::string path = folder.write("flight.csv", text);
  try {
    read_flight_csv(path, minimum_rows);
  } catch (const InputError& error) {
    return std::string(error.what()).substr(path.size() - std::string("flight.csv").size());
  }
  return "accepted";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST_CASE("a flight survives writing and reading to the bit") {
  const TemporaryFolder folder;
  const Flight flight = random_flight(500, 3);
  write_flight_csv(folder.path("flight.csv"), flight);
  CHECK(same_bits(read_flight_csv(folder.path("flight.csv")), flight));
  CHECK(folder.listing() == std::vector<std::string>{"flight.csv"});
}

TEST_CASE("a flight takes the room of its rows and no more: a long one would not fit twice") {
  const TemporaryFolder folder;
  write_flight_csv(folder.path("flight.csv"), random_flight(1100, 4));
  const Flight flight = read_flight_csv(folder.path("flight.csv"));
  CHECK(flight.size() == 1100);
  CHECK(flight.capacity() <= 1102);
  // line ends alone do not make room
  const Flight two =
      read_flight_csv(folder.write("short.csv", header + "\n" + row_1 + "\n" + row_2 + std::string(100000, '\n')), 2);
  CHECK(two.size() == 2);
  CHECK(two.capacity() <= 100000 / 42 + 20);
}

TEST_CASE("rows of an independent simulator are read as they stand") {
  const TemporaryFolder folder;
  const Flight flight = read_flight_csv(folder.write("in.csv", header + "\r\n" + row_1 + "\r\n" + row_2 + "\r\n"), 2);
  REQUIRE(flight.size() == 2);
  CHECK(flight[0].time_s == 0.05);
  CHECK(flight[0].linear_acceleration_m_s2[2] == -0.79444088);
  CHECK(flight[0].angular_acceleration_rad_s2[1] == -3.2602422);
  CHECK(flight[0].velocity_m_s[0] == 8.537749e-05);
  CHECK(flight[0].body_rates_rad_s[2] == 0.0040518781);
  CHECK(flight[1].roll_rad == 0.0020764207);
  CHECK(flight[1].pitch_rad == -0.0093431855);
  CHECK(flight[1].yaw_rad == 0.00043371267);
  CHECK(flight[1].altitude_m == 15.880524);
  CHECK(flight[1].commands == std::array<double, 4>{0.98590267, 1, 0.9482035, 0.95769918});
}

TEST_CASE("each column is needed, once") {
  const TemporaryFolder folder;
  for (const auto view : pinnquad::sample_field_names) {
    const std::string name(view);
    const std::string others = replaced("," + header + ",", "," + name + ",", ",other,");
    CHECK(complaint(folder, others.substr(1, others.size() - 2) + "\n" + row_1 + "\n") ==
          "flight.csv:1: expected a column named " + name + ", found none of that name among 21 columns");
    const std::string found = complaint(folder, header + "," + name + "\n" + row_1 + ",0\n");
    CHECK(found.substr(0, found.find(" (")) ==
          "flight.csv:1:22: expected one column named " + name + ", found a second one");
  }
}

TEST_CASE("time must increase from row to row") {
  const TemporaryFolder folder;
  CHECK(complaint(folder, header + "\n" + row_1 + "\n" + row_1 + "\n") ==
        "flight.csv:3:1: expected a time above 0.05 in column t, found 0.05");
  CHECK(complaint(folder, header + "\n" + row_2 + "\n" + row_1 + "\n") ==
        "flight.csv:3:1: expected a time above 0.1 in column t, found 0.05");
  const std::string time_last = header.substr(2) + ",t\n" + row_2.substr(6) + ",0.1\n" + row_1.substr(6) + ",-3\n";
  CHECK(complaint(folder, time_last) == "flight.csv:3:21: expected a time above 0.1 in column t, found -3");
}

TEST_CASE("a flight of too few rows is refused; by default what is accepted can be split") {
  const TemporaryFolder folder;
  const std::string path = folder.path("short.csv");
  CHECK(complaint(folder, header + "\n", pinnquad::minimum_flight_rows) ==
        "flight.csv:1: expected at least 10 rows of data, found 0");
  write_flight_csv(path, random_flight(9, 1));
  CHECK_THROWS_WITH_AS(read_flight_csv(path), (path + ":10: expected at least 10 rows of data, found 9").c_str(),
                       InputError);
  write_flight_csv(path, random_flight(10, 1));
  CHECK_NOTHROW(pinnquad::split_contiguous(read_flight_csv(path).size()));
}

TEST_CASE("a flight that could not be read back is not written, and the old file stays") {
  const TemporaryFolder folder;
  const std::string path = folder.write("out.csv", "old");
  Flight flight = random_flight(12, 2);
  SUBCASE("not finite") {
    flight[7].body_rates_rad_s[1] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(write_flight_csv(path, flight),
                         ("cannot write " + path + ": sample 7 has no finite w_y").c_str(), OutputError);
  }
  SUBCASE("time stands still") {
    flight[4].time_s = flight[3].time_s;
    CHECK_THROWS_WITH_AS(write_flight_csv(path, flight),
                         ("cannot write " + path + ": time does not increase at sample 4").c_str(), OutputError);
  }
  CHECK(folder.listing() == std::vector<std::string>{"out.csv"});
  CHECK(folder.read("out.csv") == "old");
}

TEST_CASE("extra columns: written behind the others as name and unit, read where they are asked for") {
  const TemporaryFolder folder;
  Flight flight = random_flight(12, 5);
  flight.add_column({{"battery_voltage", "V"}, std::vector<double>(12, 15.25)});
  std::vector<double> speeds;
  for (int i = 0; i < 12; ++i) speeds.push_back(100 + 1.0 / (i + 3));
  flight.add_column({{"n 1, front", "rev/s"}, speeds});  // a name that needs quotation marks
  const std::string path = folder.path("flight.csv");
  write_flight_csv(path, flight);

  const auto columns = pinnquad::extra_columns_in(path);
  REQUIRE(columns.size() == 2);
  CHECK(columns[0].name == "battery_voltage");
  CHECK(columns[1].name == "n 1, front");
  CHECK(columns[1].unit == "rev/s");
  const Flight whole = read_flight_csv(path, 1, columns);
  CHECK(same_bits(whole, flight));
  CHECK(whole.column("n 1, front")->values == speeds);
  const Flight one = read_flight_csv(path, 1, {{"battery_voltage", "V"}});
  CHECK(one.columns().size() == 1);
  CHECK(one.column("battery_voltage")->values[11] == 15.25);
  CHECK(read_flight_csv(path).columns().empty());

  const auto refused = [&](const std::vector<pinnquad::ColumnName>& wanted) {
    try {
      read_flight_csv(path, 1, wanted);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(path.size());
    }
    return std::string("accepted");
  };
  CHECK(refused({{"battery_voltage", "mV"}}) ==
        ":1:22: expected a column named battery_voltage [mV], found \"battery_voltage [V]\"");
  CHECK(refused({{"battery_voltage", "V"}, {"battery_voltage", "mV"}}) ==
        ":1: expected extra columns that differ in name, found flight: it has a column battery_voltage already");
  CHECK(refused({{"altitude", "ft"}}).find(":1: expected extra columns that differ in name") == 0);
  std::ofstream(path) << "t,u1,u2,u3,u4,u5,u6\n";
  CHECK(refused({}) == ":1: expected the commands of four motors, u1 to u4, found a column u5");
  CHECK(pinnquad::extra_columns_in(folder.write("none.csv", "")).empty());
  CHECK(pinnquad::extra_columns_in(folder.write("odd.csv", "a[V],[V],b [V] x, [V],c []\n")).size() == 1);

  Flight rest;
  for (std::size_t i = 0; i < 12; ++i) rest.push_back(flight[i]);
  rest.add_column({{"battery_voltage", "V"}, std::vector<double>(12, std::numeric_limits<double>::quiet_NaN())});
  CHECK_THROWS_AS(write_flight_csv(folder.path("bad.csv"), rest), OutputError);
}
