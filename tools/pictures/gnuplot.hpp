// SPDX-License-Identifier: MIT
// Pictures as SVG, drawn by gnuplot from a script with its data: the common look.
#pragma once

#include <cstddef>
#include <optional>
#include <sstream>
#include <string>

#include "pictures/gnuplot_process.hpp"
#include "pictures/html_text.hpp"
#include "pinnquad/io/atomic_file.hpp"

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

/// The picture with the title and description that a screen reader says; gnuplot names every picture "Gnuplot" and a
/// curve without a title "gnuplot_plot_1" or "$series using 1:2", which a browser would show under the mouse.
inline std::string with_title(std::string svg, const std::string& title, const std::string& description) {
  const auto cut = [&svg](const std::string& from, const std::string& to, std::size_t start) {
    const std::size_t first = svg.find(from, start);
    if (first == std::string::npos) return std::string::npos;
    const std::size_t last = svg.find(to, first);
    if (last == std::string::npos) return std::string::npos;
    svg.erase(first, last + to.size() - first);
    return first;
  };
  cut("<title>Gnuplot", "</title>", 0);
  cut("<desc>Produced by GNUPLOT", "</desc>", 0);
  for (const char* unnamed : {"<title>gnuplot_plot_", "<title>$"}) {
    for (std::size_t at = 0; at != std::string::npos;) at = cut(unnamed, "</title>", at);
  }
  const std::size_t root = svg.find("<svg"), inside = svg.find('>', root);
  svg.insert(inside + 1, "\n<title>" + html_text(title) + "</title>\n<desc>" + html_text(description) + "</desc>");
  return svg.insert(root + 4, " role=\"img\"");
}
}  // namespace detail

/// Alternative text of a picture, and its size in pixels.
struct Picture {
  int width = 0, height = 0;
  std::string title, description;
};

/// Draws a picture; the file appears whole or not at all. `script` is what follows gnuplot_head. False, after one line
/// on stderr, as in run_gnuplot. Throws OutputError where the file cannot be written.
inline bool draw_svg(const std::string& svg, const Picture& picture, const std::string& script) {
  pinnquad::AtomicFile file(svg);
  const std::optional<std::string> drawn = run_gnuplot(gnuplot_head(picture.width, picture.height) + script);
  if (!drawn) return false;
  file.stream() << detail::with_title(detail::without_empty_groups(*drawn), picture.title, picture.description);
  file.commit();
  return true;
}

}  // namespace programs
