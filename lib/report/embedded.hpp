// The files of lib/report/page and three.js, which cmake/embed.cmake compiles into the program.
#pragma once

#include <string_view>

namespace langer::report::embedded {

extern const std::string_view index_html, style_css, charts_js, tables_js, body_js, main_js;
extern const std::string_view three_js, orbit_js;  // empty where the build found no three.js

}  // namespace langer::report::embedded
