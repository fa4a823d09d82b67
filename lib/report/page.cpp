// Writes a report as one HTML file. The data are JSON inside of a <script>; lib/report/page/*.js
// draws them in the browser. So charts have values under the pointer, and the body can be turned,
// without a server or a network.
#include "report/page.hpp"

#include "core/base/version.hpp"
#include "core/base/xml.hpp"
#include "report/embedded.hpp"

namespace langer::report {

namespace {

// The class of a verdict in style.css.
const char* level_word(Level level) {
  if (level == Level::good) return "good";
  if (level == Level::note) return "note";
  return "warning";
}

Json boolean(bool b) {
  if (b) return {"true"};
  return {"false"};
}

// The functions below write the structures of page.hpp under the names that lib/report/page/*.js
// reads.
Json series(const Series& s) {
  return object({{"name", words(s.name)},
                 {"x", numbers(s.x)},
                 {"y", numbers(s.y)},
                 {"error", numbers(s.error)},
                 {"points", boolean(s.points)}});
}

Json answer(const Answer& a) {
  const auto fact = [](const Answer::Fact& f) {
    return object({{"name", words(f.name)}, {"text", words(f.text)}});
  };
  return object({{"sentence", words(a.sentence)}, {"facts", list(a.facts, fact)}});
}

Json matrix(const Matrix& m) {
  return object({{"title", words(m.title)},
                 {"names", list(m.names, words)},
                 {"values", list(m.values, numbers)}});
}

Json plane_map(const PlaneMap& m) {
  return object({{"title", words(m.title)},
                 {"xLabel", words(m.x_label)},
                 {"yLabel", words(m.y_label)},
                 {"label", words(m.label)},
                 {"unit", words(m.unit)},
                 {"at", numbers(m.at)},
                 {"values", list(m.values, numbers)},
                 {"middle", number(m.middle)}});
}

Json chart(const Chart& c) {
  const auto mark = [](const Chart::Mark& m) {
    return object({{"name", words(m.name)}, {"y", number(m.y)}});
  };
  return object({{"group", words(c.group)},
                 {"title", words(c.title)},
                 {"xLabel", words(c.x_label)},
                 {"xUnit", words(c.x_unit)},
                 {"yLabel", words(c.y_label)},
                 {"yUnit", words(c.y_unit)},
                 {"series", list(c.series, series)},
                 {"marks", list(c.marks, mark)},
                 {"ordered", boolean(c.ordered)}});
}

Json polar(const Polar& p) {
  const auto residual = [](const SymmetryResidual& r) {
    return object(
        {{"says", words(r.says)}, {"pairs", number(r.pairs)}, {"value", number(r.value)}});
  };
  return object({{"title", words(p.title)},
                 {"axis", words(p.axis)},
                 {"unit", words(p.unit)},
                 {"angle", numbers(p.angle)},
                 {"series", list(p.series, series)},
                 {"residuals", list(p.residuals, residual)}});
}

// All data of a page as one object. Its keys are those of main.js.
Json data_of(const ReportPage& page) {
  const auto verdict = [](const Verdict& v) {
    return object(
        {{"level", words(level_word(v.level))}, {"of", words(v.of)}, {"text", words(v.text)}});
  };
  const auto table = [](const ReportTable& t) {
    const auto column = [](const TableColumn& c) {
      return object({{"name", words(c.name)}, {"unit", words(c.unit)}});
    };
    const auto cell = [](const Cell& c) {
      if (std::holds_alternative<double>(c)) return number(std::get<double>(c));
      return words(std::get<std::string>(c));
    };
    const auto row = [&](const std::vector<Cell>& cells) {
      return list(cells, cell);
    };
    return object({{"title", words(t.title)},
                   {"columns", list(t.columns, column)},
                   {"rows", list(t.rows, row)}});
  };
  const auto origin = [](const FileOrigin& o) {
    return object({{"label", words(o.label)},
                   {"stage", words(o.stage)},
                   {"made", words(o.made)},
                   {"host", words(o.host)},
                   {"version", words(o.version)},
                   {"libraries", words(o.libraries)},
                   {"command", words(o.command)},
                   {"content", words(o.content)},
                   {"config", words(o.config)},
                   {"wall", number(o.wall)},
                   {"cpu", number(o.cpu)}});
  };
  return object({{"title", words(page.title)},
                 {"version", words(fmt::format("{} ({})", version, revision))},
                 {"answers", list(page.answers, answer)},
                 {"matrices", list(page.matrices, matrix)},
                 {"maps", list(page.maps, plane_map)},
                 {"verdicts", list(page.verdicts, verdict)},
                 {"charts", list(page.charts, chart)},
                 {"polars", list(page.polars, polar)},
                 {"tables", list(page.tables, table)},
                 {"bodies", list(page.bodies)},
                 {"origins", list(page.origins, origin)}});
}

}  // namespace

bool has_three() { return !embedded::three_js.empty(); }

// The size of a page with three.js but without results; the rest of the allowed size is for bodies.
std::size_t bytes_without_data() {
  using namespace embedded;
  return index_html.size() + style_css.size() + three_js.size() + orbit_js.size() +
         charts_js.size() + tables_js.size() + body_js.size() + main_js.size();
}

// Fills the placeholders {{name}} of index.html. three.js is included only if the page shows a
// body, because it is most of the page's size.
std::string html(const ReportPage& page) {
  using namespace embedded;
  const std::string data = data_of(page).text;
  const std::string title = xml_text(page.title);
  const bool view = has_three() && !page.bodies.empty();
  std::string_view three;
  std::string_view orbit;
  if (view) {
    three = three_js;
    orbit = orbit_js;
  }
  const std::pair<std::string_view, std::string_view> parts[] = {
      {"title", title},      {"style", style_css}, {"three", three},
      {"orbit", orbit},      {"data", data},       {"charts", charts_js},
      {"tables", tables_js}, {"body", body_js},    {"main", main_js}};
  // A value may contain braces itself, so the text is scanned once and never searched again.
  std::string text;
  std::string_view rest = index_html;
  for (;;) {
    const auto open = rest.find("{{");
    if (open == rest.npos) break;
    const auto close = rest.find("}}", open);
    const std::string_view name = rest.substr(open + 2, close - open - 2);
    text += rest.substr(0, open);
    for (const auto& [key, value] : parts)
      if (key == name) text += value;
    rest = rest.substr(close + 2);
  }
  return text + std::string(rest);
}

}  // namespace langer::report
