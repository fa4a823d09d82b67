// The files of the set-up page, compiled into the program (cmake/embed.cmake).
#pragma once

#include <string_view>
#include <vector>

namespace langer {

namespace serve_page {
extern const std::string_view index_html, style_css, app_js, form_js, view_js, chart_js;
}

struct PageFile {
  const char* name;  // in the address; "" is the page itself
  const char* type;
  std::string_view text;
};
const std::vector<PageFile>& page_files();

}  // namespace langer
