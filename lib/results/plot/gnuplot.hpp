// Figures by gnuplot: plain x-y plots of CSV columns, as SVG, PNG, PDF and EPS. Only these
// functions know that gnuplot exists. The script stands beside the pictures and can be run again by
// hand, in its folder. Colours are Okabe and Ito's set for colour-blind readers; markers and dashes
// differ too, so that figures survive black and white print. Texts are gnuplot's enhanced text (u_y
// has a subscript); quotes and line breaks in them do no harm.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace langer {

enum class AxisScale { linear, log_x, log_y, log };
constexpr auto names(AxisScale) { return std::array{"linear", "log_x", "log_y", "log"}; }

struct PlotLine {
  std::string csv;   // file, relative to the script
  std::string x, y;  // heads of its columns
  std::string legend;
  bool points =
      false;          // open markers instead of a line: a curve that lies on another stays visible
  std::string names;  // column of texts written beside the points
  std::string low, high;       // columns of the ends of a bar through each point; empty: none
  std::string error;           // column of the half width of a band about the line; empty: none
  int colour = -1, dash = -1;  // numbers of its colour and of its dashes and marker; by default
                               // both differ from line to line
  bool values =
      false;  // the legend holds values of keys, whose numbers take the decimal sign of the style
};

// A line across the figure that curves are compared with, and what it says.
struct PlotMark {
  double y = 0;
  std::string text;
};

struct Plot {
  std::string title;             // may be empty
  std::string x_label, y_label;  // with units
  std::vector<PlotLine> lines;
  AxisScale scale = AxisScale::linear;
  double x_step = 0;  // between the tics of x, where that matters
  int rows =
      0;  // of the CSV files, where known: long curves get a marker on some of their points only
  std::vector<PlotMark> marks = {};
  std::vector<std::string> notes =
      {};  // plain lines beside the figure, such as what its numbers stand for
  std::optional<double> y_most = {};  // the axis ends there, whatever lies above
  bool y_label_is_unit = false;       // nothing but a unit
};

struct FigureStyle;
// writes <name> in the formats of the style when run
std::string gnuplot_script(const Plot& plot, const std::string& name, const FigureStyle& style);

std::string gnuplot_string(const std::string& text);  // as a gnuplot string
// a file's name as one: "<", "|", "-", "$" and the like at its begin would make it a pipe, a stream
// or a block of data
std::string gnuplot_file(const std::string& name);
// Sends what follows to this file: beside the script if it is run by hand; in a folder of its own,
// named by the variable `into`, if run_gnuplot runs it.
std::string gnuplot_output(const std::string& file);
std::string literal(const std::string& name);  // enhanced text that prints as it stands
std::string plain(const std::string& text);    // enhanced text without its marks: σ_xx for σ_{xx}

// Runs <folder>/<script> there and moves the pictures beside it. Returns what went wrong, "" if
// nothing: no gnuplot on the PATH, its complaint, too slow.
std::string run_gnuplot(const std::string& folder, const std::string& script);

}  // namespace langer
