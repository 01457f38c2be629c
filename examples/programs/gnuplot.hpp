// SPDX-License-Identifier: MIT
// Pictures as SVG, drawn by gnuplot from a script and data that go through a pipe: the way there and the common look.
#pragma once

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "pinnquad/data/atomic_file.hpp"

namespace programs {

/// Runs gnuplot on a script. False, after one line on stderr, if gnuplot is missing or refuses it.
inline bool run_gnuplot(const std::string& script) {
  std::FILE* pipe = popen("gnuplot 2>/dev/null", "w");
  if (pipe == nullptr) return false;
  const bool written = std::fwrite(script.data(), 1, script.size(), pipe) == script.size();
  const int code = pclose(pipe);
  if (!written || code != 0) std::fprintf(stderr, "plots: gnuplot is missing or failed (Debian: gnuplot-nox)\n");
  return written && code == 0;
}

/// A path for gnuplot's single quotes.
inline std::string gnuplot_quoted(const std::string& path) {
  std::string result = "'";
  for (const char c : path) result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
}

/// The common look: light grid, named colours for target and prediction.
inline std::string gnuplot_head(const std::string& svg, int width, int height) {
  std::ostringstream out;
  out << "set terminal svg size " << width << "," << height << " font 'Helvetica,13' background rgb 'white'\n"
      << "set output " << gnuplot_quoted(svg) << "\n"
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

/// Draws a picture; the file appears whole or not at all. `script` is what follows gnuplot_head. False as in run_gnuplot.
/// Throws OutputError where the file cannot be written.
inline bool draw_svg(const std::string& svg, int width, int height, const std::string& script) {
  pinnquad::AtomicFile file(svg);
  std::signal(SIGPIPE, SIG_IGN);  // a gnuplot that is not there is an error to report, not an end without a word
  const std::string drawing = svg + ".drawing";
  const bool drawn = run_gnuplot(gnuplot_head(drawing, width, height) + script);
  std::ostringstream text;
  if (drawn) text << std::ifstream(drawing, std::ios::binary).rdbuf();
  std::error_code ignored;
  std::filesystem::remove(drawing, ignored);
  if (drawn) {
    file.stream() << detail::without_empty_groups(text.str());
    file.commit();
  }
  return drawn;
}

}  // namespace programs
