#include "serve/page_files.hpp"

#include "report/embedded.hpp"

namespace langer {

// three.js and its controls are those of the reports, so the program has them once.
const std::vector<PageFile>& page_files() {
  constexpr const char* script = "text/javascript; charset=utf-8";
  static const std::vector<PageFile> files = {
      {"", "text/html; charset=utf-8", serve_page::index_html},
      {"style.css", "text/css; charset=utf-8", serve_page::style_css},
      {"app.js", script, serve_page::app_js},
      {"form.js", script, serve_page::form_js},
      {"view.js", script, serve_page::view_js},
      {"chart.js", script, serve_page::chart_js},
      {"three.js", script, report::embedded::three_js},
      {"orbit.js", script, report::embedded::orbit_js}};
  return files;
}

}  // namespace langer
