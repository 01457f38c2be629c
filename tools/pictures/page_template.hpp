// SPDX-License-Identifier: MIT
// Pages of text without their figures, as files of this repository; they are compiled in (pictures/CMakeLists.txt).
#pragma once

namespace programs {

extern const char* const report_template;    ///< report/report.html, in the language of mustache
extern const char* const log_page_template;  ///< training/log_page.html, the same
extern const char* const page_style;         ///< pictures/page.css and pictures/text_page.css

}  // namespace programs
