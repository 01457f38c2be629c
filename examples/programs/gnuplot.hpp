// SPDX-License-Identifier: MIT
// Pictures as SVG, drawn by gnuplot from a script and data that go through a pipe: the way there and the common look.
#pragma once

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>

#include "pinnquad/data/file_error.hpp"

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

/// Draws a picture; the file appears whole or not at all. `script` is what follows gnuplot_head. False as in run_gnuplot.
/// Throws OutputError where the file cannot be put in its place.
inline bool draw_svg(const std::string& svg, int width, int height, const std::string& script) {
  const std::string partial = svg + ".partial";
  std::signal(SIGPIPE, SIG_IGN);  // a gnuplot that is not there is an error to report, not an end without a word
  const bool drawn = run_gnuplot(gnuplot_head(partial, width, height) + script);
  std::error_code error;
  if (drawn) std::filesystem::rename(partial, svg, error);
  if (!drawn || error) {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
  }
  if (error) throw pinnquad::OutputError(svg, error.message());
  return drawn;
}

}  // namespace programs
