// SPDX-License-Identifier: MIT
// Pictures as SVG, drawn by gnuplot from a script with its data: the common look.
#pragma once

#include <optional>
#include <sstream>
#include <string>

#include "pictures/gnuplot_process.hpp"
#include "pinnquad/data/atomic_file.hpp"

namespace programs {

/// The common look: light grid, named colours for target and prediction.
inline std::string gnuplot_head(int width, int height) {
  std::ostringstream out;
  out << "set terminal svg size " << width << "," << height << " font 'Helvetica,13' background rgb 'white'\n"
      << "set grid lc rgb '#e0e0e0'\nset border lc rgb '#707070'\nset key textcolor rgb '#303030'\n";
  return out.str();
}

namespace detail {
/// gnuplot opens a group for every tic and label and leaves half of them empty: a third of a small picture.
inline std::string without_empty_groups(const std::string& svg) {
  const std::string start = "<g fill=\"none\"", end = ">\n</g>\n";
  std::string result;
  std::size_t at = 0;
  for (std::size_t group = svg.find(start); group != std::string::npos; group = svg.find(start, at)) {
    const std::size_t close = svg.find('>', group);
    result.append(svg, at, group - at);
    at = group;
    if (close != std::string::npos && svg.compare(close, end.size(), end) == 0) {
      at = close + end.size();
    } else {
      result.append(start);
      at += start.size();
    }
  }
  return result.append(svg, at, std::string::npos);
}
}  // namespace detail

/// Draws a picture; the file appears whole or not at all. `script` is what follows gnuplot_head. False, after one line
/// on stderr, as in run_gnuplot. Throws OutputError where the file cannot be written.
inline bool draw_svg(const std::string& svg, int width, int height, const std::string& script) {
  pinnquad::AtomicFile file(svg);
  const std::optional<std::string> drawn = run_gnuplot(gnuplot_head(width, height) + script);
  if (!drawn) return false;
  file.stream() << detail::without_empty_groups(*drawn);
  file.commit();
  return true;
}

}  // namespace programs
