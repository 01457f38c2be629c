// SPDX-License-Identifier: MIT
// The page of a report without its figures, as files of this repository; they are compiled in (report/CMakeLists.txt).
#pragma once

namespace programs {

extern const char* const report_template;  ///< report/report.html, in the language of mustache
extern const char* const page_style;       ///< pictures/page.css

}  // namespace programs
