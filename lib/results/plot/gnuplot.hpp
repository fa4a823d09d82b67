// Figures by gnuplot: x-y plots of CSV columns, as SVG, PNG, PDF and EPS.
//
// Only the functions of this header know that gnuplot exists. They write a script into the folder
// of the pictures; a user can run it again by hand in that folder. Colours are the set of Okabe and
// Ito for colour-blind readers. Markers and dashes differ too, so that figures survive print
// without colour. Texts are gnuplot's enhanced text (u_y has a subscript). Quotes and line breaks
// in texts and special names of files do no harm: every text goes through gnuplot_string or
// gnuplot_file.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace langer {

enum class AxisScale { linear, log_x, log_y, log };
constexpr auto names(AxisScale) { return std::array{"linear", "log_x", "log_y", "log"}; }

// One curve of a plot: columns of a CSV file, and how they are drawn.
struct PlotLine {
  std::string csv;   // file, relative to the script
  std::string x, y;  // heads of its columns
  std::string legend;
  // Open markers instead of a line, so that a curve with the same values stays visible.
  bool points = false;
  std::string names;      // column of texts written next to the points
  std::string low, high;  // columns of the ends of a bar through each point; empty: none
  std::string error;      // column of the half width of a band about the line; empty: none
  // Numbers of its colour and of its dashes and marker; -1: the number of the line.
  int colour = -1, dash = -1;
  // The legend holds values of keys, whose numbers get the decimal sign of the style.
  bool values = false;
};

// A horizontal line across the figure that curves are compared with, and its text.
struct PlotMark {
  double y = 0;
  std::string text;
};

// An x-y figure: its curves, axes and notes.
struct Plot {
  std::string title;             // may be empty
  std::string x_label, y_label;  // with units
  std::vector<PlotLine> lines;
  AxisScale scale = AxisScale::linear;
  double x_step = 0;  // distance of the tics of x; 0: chosen by gnuplot
  int rows = 0;       // of the CSV files; long curves get a marker on some of their points only
  std::vector<PlotMark> marks = {};
  std::vector<std::string> notes = {};  // plain lines at the right of the figure
  std::optional<double> y_most = {};    // the y axis ends there at the latest
  bool y_label_is_unit = false;         // y_label is a unit alone
};

struct FigureStyle;
// A script that writes <name> in the formats of the style.
std::string gnuplot_script(const Plot& plot, const std::string& name, const FigureStyle& style);

// The text between quotes, as gnuplot reads it.
std::string gnuplot_string(const std::string& text);
// The name of a file between quotes. A name that begins with "<", "|", "-", "$" or the like would
// be a pipe, a stream or a block of data; it gets "./" in front.
std::string gnuplot_file(const std::string& name);
// Commands that send the following plot to a file: in the current folder if a user runs the script,
// in the folder of the variable `into` if run_gnuplot does.
std::string gnuplot_output(const std::string& file);
std::string literal(const std::string& name);  // enhanced text that prints exactly the name
std::string plain(const std::string& text);    // enhanced text without its marks: σ_xx for σ_{xx}

// Runs <folder>/<script> in that folder and moves the pictures into it. Returns the reason of a
// failure, "" if there is none: no gnuplot on the PATH, its error message, or too slow.
std::string run_gnuplot(const std::string& folder, const std::string& script);

}  // namespace langer
