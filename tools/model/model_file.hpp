// SPDX-License-Identifier: MIT
// A model from its file: a block, or an exported header as one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/header_airframe.hpp"
#include "model/header_block.hpp"
#include "model/identity.hpp"
#include "pinnquad/io/text_file.hpp"

namespace programs {

/// Throws InputError where the header says other names than its Features and its Outputs have, as far as they are of
/// the kinds that find_identity() tries.
void require_names(const HeaderFile& header);

/// An exported header as a block. The hints become what the header states where they were empty. Throws InputError for
/// one that was edited since its export, and for one that says another frame, vehicle or motor order than its
/// airframe's.
inline std::vector<unsigned char> header_block(const HeaderFile& header, ModelHints& hints) {
  if (hints.answer.empty()) hints.answer = answer_of(header);
  hints.own = own_airframe(header);
  const pinnquad::Airframe<double> airframe =
      hints.own ? hints.own->value : chosen_airframe(header.quoted("vehicle_name")).value;
  header.require_contents(airframe);
  require_names(header);
  if (detail::signs_of(header, "motor_torque_signs") != pinnquad::motor_torque_signs(airframe)) {
    header.refuse("motor_torque_signs", "the signs of its airframe's rotors", "others");
  }
  return block_of(header);
}

/// The bytes of a block, whichever the file is: a block, or an exported header as one. The hints become what the header
/// states where they were empty.
inline std::string block_bytes(const std::string& path, ModelHints& hints) {
  if (std::filesystem::path(path).extension() != ".hpp") return pinnquad::file_text(path);
  const HeaderFile header(path);
  const std::vector<unsigned char> bytes = header_block(header, hints);
  return {bytes.begin(), bytes.end()};
}

}  // namespace programs
