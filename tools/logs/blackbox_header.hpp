// SPDX-License-Identifier: MIT
// The head of a blackbox log: lines "H name:value" that say which fields a frame of each letter has, how they are
// written and predicted, and how the vehicle was set.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace pinnquad::logs::blackbox {

/// The first line of every flight's log; a file of several flights has it several times.
inline constexpr std::string_view magic = "H Product:Blackbox flight data recorder by Nicholas Sherlock\n";

/// The number added to a field's number: the number in a header's "Field X predictor".
enum Predictor : int {
  zero = 0,
  previous = 1,
  straight_line = 2,
  average_of_two = 3,
  least_throttle = 4,
  first_motor = 5,
  counted = 6,
  home = 7,
  fixed_1500 = 8,
  reference_voltage = 9,
  last_time = 10,
  least_motor = 11
};

struct Field {
  std::string name;  ///< "gyroADC[0]"
  bool is_signed = false;
  int predictor = zero;
  int encoding = 0;
};

struct Header {
  std::map<char, std::vector<Field>> frames;  ///< by their letter; P has the names of I
  std::map<std::string, std::string> texts;   ///< "Firmware revision", "motorOutput" ...
  int data_version = 2;
  std::int64_t every_i = 32;                   ///< one I frame in so many iterations
  std::int64_t logged = 1, of_iterations = 1;  ///< so many P frames of so many iterations
  std::int64_t least_throttle = 1150, reference_voltage = 4095;
  std::int64_t least_motor = 1150, most_motor = 0;  ///< 0: not said
  double gyro_deg_s = 1;                            ///< of a gyroscope's unit
  double acceleration_1g = 0;                       ///< accelerometer units in 1 g; 0: not said
  std::size_t end = 0;                              ///< the first byte behind the head

  const std::vector<Field>* fields(char letter) const {
    const auto found = frames.find(letter);
    return found == frames.end() ? nullptr : &found->second;
  }
  bool is_inav() const;
  /// "4.3.1" of "Betaflight 4.3.1 (8d4f005) STM32F7X2"; 0.0 where it says none.
  bool is_at_least(int major, int minor) const;
};

/// The head that begins at `begin`. Throws InputError with the byte: fields whose lists differ in length, none at all,
/// more than a logger has, an encoding or a predictor that no firmware writes.
Header read_header(std::string_view file, std::size_t begin, const std::string& name);

}  // namespace pinnquad::logs::blackbox
