#include "results/plot/gnuplot.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/output_file.hpp"
#include "core/base/printable.hpp"
#include "core/base/text.hpp"
#include "core/hdf5/seal.hpp"
#include "results/plot/figure_style.hpp"

namespace langer {

namespace {

constexpr std::array colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                             "#E69F00", "#56B4E9", "#000000"};
constexpr std::array markers{7, 5, 8, 10, 12, 6, 4};
constexpr std::array open_markers{6, 4, 8, 10, 12};
// Every second line is dashed, so that both colours are seen where two curves coincide.
constexpr std::array dashes{1, 1, 2, 2, 4, 4, 5};
constexpr int most_markers = 25;  // on a line
constexpr std::chrono::seconds time_limit{120};

// The last line of a file that is more than spaces and carets: gnuplot's error message.
std::string last_line(const std::string& path) {
  std::ifstream file(path);
  std::string last;
  for (std::string line; std::getline(file, line);)
    if (line.find_first_not_of(" \t^") != std::string::npos) last = line;
  return last;
}

// A text of a figure with spaces that cannot be dropped: SVG viewers drop a space next to a
// subscript.
std::string printed(const std::string& text) {
  std::string s;
  for (char c : text) {
    if (c == ' ') {
      s += "\u00a0";
    } else {
      s += std::string(1, c);
    }
  }
  return gnuplot_string(s);
}

}  // namespace

// Within single quotes gnuplot knows one special character, the quote itself, which is doubled.
// Control characters become blanks.
std::string gnuplot_string(const std::string& text) {
  std::string s = "'";
  for (char c : text) {
    if (c == '\'') s += '\'';
    if (is_control(c)) {
      s += ' ';
    } else {
      s += c;
    }
  }
  return s + "'";
}

std::string gnuplot_file(const std::string& name) {
  const bool is_safe = !name.empty() && (std::isalnum(static_cast<unsigned char>(name[0])) ||
                                         std::strchr("_./", name[0]));
  if (is_safe) return gnuplot_string(name);
  return gnuplot_string("./" + name);
}

// A backslash before each mark of enhanced text.
std::string literal(const std::string& name) {
  std::string s;
  for (char c : name) {
    if (std::strchr("_^{}@&~\\", c)) s += '\\';
    s += c;
  }
  return s;
}

std::string plain(const std::string& text) {
  std::string s;
  for (char c : text)
    if (!std::strchr("{}\\", c)) s += c;
  return s;
}

namespace {

// Size of words within a figure.
double small_size(const FigureStyle& style) { return 0.86 * style.points(); }

// The arguments of `plot` for line i: its error band, the line itself, its bars and its names.
std::string plot_arguments(const Plot& plot, const PlotLine& line, std::size_t i,
                           const FigureStyle& style) {
  const int every = std::max(1, (plot.rows + most_markers - 1) / most_markers);
  std::size_t colour = i;
  if (line.colour >= 0) colour = static_cast<std::size_t>(line.colour);
  // Lines after the last colour begin the colours again, with other dashes.
  std::size_t dash = i + i / colours.size();
  if (line.dash >= 0) dash = static_cast<std::size_t>(line.dash) * 2;
  const char* const rgb = colours[colour % colours.size()];
  const std::string file = gnuplot_file(line.csv);
  const std::string x = gnuplot_string(line.x);
  const std::string y = gnuplot_string(line.y);
  std::string s;
  if (!line.error.empty())
    s += fmt::format(
        "{0} using (column({1})):(column({2})-column({3})):(column({2})+column({3})) with "
        "filledcurves fs transparent solid 0.2 "
        "noborder lc rgb '{4}' notitle, \\\n     ",
        file, x, y, gnuplot_string(line.error), rgb);
  s += fmt::format("{} using {}:{}", file, x, y);
  if (line.points)
    s += fmt::format(" every {} with points lw 1.5 lc rgb '{}' pt {} ps 1.3", every, rgb,
                     open_markers[dash % open_markers.size()]);
  else
    s += fmt::format(" with linespoints lw 2 lc rgb '{}' dt {} pt {} ps 0.6 pi {}", rgb,
                     dashes[dash % dashes.size()], markers[dash % markers.size()], every);
  std::string legend = line.legend;
  if (line.values) legend = with_decimal(legend, style.decimal);
  s += fmt::format(" title {}", printed(legend));
  if (!line.low.empty())
    s +=
        fmt::format(", \\\n     {} using {}:{}:{}:{} with yerrorbars lw 1 lc rgb '{}' pt 0 notitle",
                    file, x, y, gnuplot_string(line.low), gnuplot_string(line.high), rgb);
  if (!line.names.empty())
    s += fmt::format(
        ", \\\n     {} using {}:{}:{} with labels noenhanced left offset 0.6,0.4 font ',{:.3g}' tc "
        "rgb '#555555' notitle",
        file, x, y, gnuplot_string(line.names), small_size(style));
  return s;
}

const char* logarithmic_axes(AxisScale scale) {
  if (scale == AxisScale::log) return "xy";
  if (scale == AxisScale::log_x) return "x";
  return "y";
}

// Commands for everything around the curves: axes, title, labels, marks and notes.
std::string frame_commands(const Plot& plot, const FigureStyle& style) {
  std::string s = "set encoding utf8\nset datafile separator comma\nset datafile columnheaders\n";
  if (style.decimal == DecimalSign::comma) s += "set decimalsign ','\n";
  s += "set border 3 lw 1.2\nset tics nomirror out scale 0.7\nset grid lt 1 lw 0.5 lc rgb "
       "'#d8d8d8'\n";
  s += "set key outside center top horizontal reverse Left samplen 3\n";
  if (plot.lines.size() == 1) s += "unset key\n";
  if (!plot.title.empty() && style.titles) s += fmt::format("set title {}\n", printed(plot.title));
  s += fmt::format("set xlabel {}\nset ylabel {}\n", printed(plot.x_label), printed(plot.y_label));
  if (plot.scale != AxisScale::linear)
    s += fmt::format("set logscale {}\n", logarithmic_axes(plot.scale));
  if (plot.x_step > 0) s += fmt::format("set xtics {}\n", plot.x_step);
  if (plot.y_most) s += fmt::format("set yrange [*:*<{:g}]\n", *plot.y_most);
  for (const PlotMark& mark : plot.marks)
    s += fmt::format(
        "set arrow from graph 0, first {0:g} to graph 1, first {0:g} nohead dt 2 lc rgb '#555555'\n"
        "set label {1} at graph 0.99, first {0:g} right offset 0,0.6 font ',{2:.3g}' tc rgb "
        "'#555555'\n",
        mark.y, printed(with_decimal(mark.text, style.decimal)), small_size(style));
  if (plot.notes.empty()) return s;
  s += "set rmargin at screen 0.66\n";
  // Notes are placed below each other at the right; many notes get less distance.
  const double step = std::min(0.052, 0.84 / static_cast<double>(plot.notes.size()));
  for (std::size_t i = 0; i < plot.notes.size(); ++i)
    s += fmt::format(
        "set label {} at screen 0.68,{:.4f} noenhanced font ',{:.3g}' tc rgb '#333333'\n",
        printed(with_decimal(plot.notes[i], style.decimal)), 0.88 - step * static_cast<double>(i),
        small_size(style));
  return s;
}

// A label whose unit gets a factor, as a gnuplot expression of its exponent e: energy (N mm)
// becomes energy (10^{-4} N mm).
std::string with_factor(const std::string& label, bool is_unit) {
  std::size_t unit = std::string::npos;
  if (label.ends_with(')')) unit = label.rfind('(');
  const std::string factor = " . sprintf('10^{%d}', e) . ";
  if (is_unit) return "''" + factor + printed(" " + label);
  if (unit == std::string::npos) return printed(label + " (") + factor + "')'";
  return printed(label.substr(0, unit + 1)) + factor + printed(" " + label.substr(unit + 1));
}

// Commands that give an axis a common factor. On one axis gnuplot would otherwise write 0.0001 next
// to 5×10^{-5}, or 800000 next to 10^6, and 0.0002, 0.0004, ... along x leave no gaps. It knows the
// ends of an axis only after a plot, so the plot is first drawn to /dev/null. Axes without such
// numbers stay as gnuplot makes them.
std::string factor_commands(const Plot& plot, const std::string& draw) {
  const bool x =
      plot.x_step == 0 && (plot.scale == AxisScale::linear || plot.scale == AxisScale::log_y);
  const bool y = plot.scale == AxisScale::linear || plot.scale == AxisScale::log_x;
  if (!x && !y) return "";
  std::string s =
      "# an axis that gnuplot would number as 0.0001 and 5x10^{-5}, or 800000 and 10^6, gets a "
      "common factor\n";
  s += "set terminal dumb\nset output '/dev/null'\n" + draw + "\n";
  s += "mixed(a, b) = a < b && (a <= -1e6 || b >= 1e6 || (b - a < 5.6e-4 && a < 1e-4 && b > "
       "-1e-4))\n";
  s += "crowded(a, b) = a < b && b < 5e-3 && a > -5e-3\n";
  s += "step(r, p) = p * (r < 1.01 * p ? 0.1 : r < 2.01 * p ? 0.2 : r < 4.99 * p ? 0.5 : 1)\n";
  for (const char axis : {'x', 'y'}) {
    const bool is_x = axis == 'x';
    if (is_x && !x) continue;
    if (!is_x && !y) continue;
    std::string label;
    std::string condition = "mixed(a, b)";
    if (is_x) {
      condition += " || crowded(a, b)";
      label = with_factor(plot.x_label, false);
    } else {
      label = with_factor(plot.y_label, plot.y_label_is_unit);
    }
    s += fmt::format(
        "a = GPVAL_{0}_MIN; b = GPVAL_{0}_MAX\n"
        "if ({3}) {{\n"
        "  e = floor(log10(b > -a ? b : -a) + 1e-9)\n"
        "  s = step(b - a, 10**floor(log10(b - a) + 1e-9))\n"
        "  set {1}range [a:b]\n"
        "  set {1}label {2}\n"
        "  set {1}tics ()\n"
        "  do for [k = ceil(a / s - 1e-6) : floor(b / s + 1e-6)] {{ set {1}tics add "
        "(gprintf('%.8g', k * s / 10.0**e) k * s) }}\n"
        "}}\n",
        static_cast<char>(axis - 'x' + 'X'), axis, label, condition);
  }
  return s;
}

// The arguments of `set terminal`. Without a width or a size of the font a PNG has fixed sizes that
// suit a screen.
std::string terminal_arguments(PictureFormat format, const FigureStyle& style) {
  const double inches = style.width_mm() / 25.4;
  double tall = inches / 1.5;
  if (style.height) tall = *style.height / 25.4;
  const double points = style.points();
  const double thick = points / 10.5;
  const double pixels = style.dpi / 96.0;
  double size = points;
  if (format == PictureFormat::svg) size = points / 0.75;  // in pixels
  const std::string font = gnuplot_string(fmt::format("{},{:.4g}", style.font, size));
  const char* const resizing = style.on_paper() ? "fixed" : "dynamic";
  switch (format) {
    case PictureFormat::svg:
      return fmt::format(
          "svg enhanced size {:.0f},{:.0f} {} font {} linewidth {:.3g} background rgb 'white'",
          96 * inches, 96 * tall, resizing, font, thick);
    case PictureFormat::png:
      if (style.on_paper())
        return fmt::format(
            "pngcairo enhanced size {:.0f},{:.0f} font {} fontscale {:.4g} linewidth {:.4g} "
            "pointscale {:.4g} background rgb 'white'",
            style.dpi * inches, style.dpi * tall, font, pixels, pixels * thick, pixels * thick);
      return fmt::format(
          "pngcairo enhanced size {:.0f},{:.0f} font {} fontscale {:g} linewidth {:g} pointscale "
          "{:g} background rgb 'white'",
          style.dpi * inches, style.dpi * tall, gnuplot_string(style.font + ",13"), pixels, pixels,
          pixels);
    default:
      return fmt::format(
          "{}cairo enhanced size {:.4f}in,{:.4f}in font {} linewidth {:.3g} pointscale {:.3g}",
          word_of(format), inches, tall, font, thick, 0.75 * thick);
  }
}

}  // namespace

// The script repeats the plot for each format, because gnuplot draws into one file at a time.
std::string gnuplot_script(const Plot& plot, const std::string& name, const FigureStyle& style) {
  std::string s = fmt::format("# made by langer; run again with: gnuplot {}.gp\n", name) +
                  frame_commands(plot, style);
  std::string lines;
  for (std::size_t i = 0; i < plot.lines.size(); ++i)
    append(lines, ", \\\n     ", plot_arguments(plot, plot.lines[i], i, style));
  const std::string draw = "plot " + lines;
  s += factor_commands(plot, draw);
  for (PictureFormat format : style.formats)
    s += fmt::format("set terminal {}\n{}{}\n", terminal_arguments(format, style),
                     gnuplot_output(name + "." + word_of(format)), draw);
  return s + "unset output\n";
}

std::string gnuplot_output(const std::string& file) {
  return fmt::format("if (!exists('into')) into = ''\nset output into.{}\n", gnuplot_file(file));
}

namespace {

// Overwrites the dates in the lines "/CreationDate (D:20260131120000Z)" of a PDF and
// "%%CreationDate: Sat Jan 31 12:00:00 2026" of an EPS. Cairo writes the time of day there. Both
// dates have a fixed length, so another one fits without moving a byte.
void set_creation_date(std::string& picture, std::time_t epoch) {
  std::tm parts{};
  if (!gmtime_r(&epoch, &parts)) return;
  const auto overwrite = [&](const std::string& before, const char* format) {
    std::array<char, 64> date{};
    const std::size_t length = std::strftime(date.data(), date.size(), format, &parts);
    const std::size_t at = picture.find(before);
    if (at == std::string::npos || at + before.size() + length > picture.size()) return;
    picture.replace(at + before.size(), length, date.data(), length);
  };
  overwrite("/CreationDate (D:", "%Y%m%d%H%M%S");
  overwrite("\n%%CreationDate: ", "%a %b %e %H:%M:%S %Y");
}

// Runs gnuplot in `folder` and waits for it. Its pictures go to the folder `into` below, its
// messages to a log there. Returns the reason of a failure.
std::string wait_for_gnuplot(const std::string& folder, const std::string& script,
                             const std::string& into) {
  const std::string log = (std::filesystem::path(folder) / into / "log").string();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  const int log_flags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW;
  posix_spawn_file_actions_addopen(&actions, 2, log.c_str(), log_flags, 0644);
  const std::string current = text_or(folder, ".");
  posix_spawn_file_actions_addchdir_np(&actions, current.c_str());

  // gnuplot gets the default reaction to the signals that this program ignores.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t usual;
  sigemptyset(&usual);
  sigaddset(&usual, SIGPIPE);
  sigaddset(&usual, SIGXFSZ);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);

  // gnuplot -e "into = '<folder>/'" ./<script>
  std::string program = "gnuplot";
  std::string execute = "-e";
  std::string place = fmt::format("into = '{}/'", into);
  std::string file = "./" + script;  // a name may begin with -
  char* const arguments[] = {program.data(), execute.data(), place.data(), file.data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, "gnuplot", &actions, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT) return "there is no gnuplot on the PATH";
  if (error) return fmt::format("gnuplot cannot be started: {}", std::strerror(error));

  // Wait for its end, but not longer than the time limit.
  int status = 0;
  pid_t ended = 0;
  const auto deadline = std::chrono::steady_clock::now() + time_limit;
  while (ended == 0 && std::chrono::steady_clock::now() < deadline) {
    ended = waitpid(child, &status, WNOHANG);
    if (ended == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (ended == 0) {
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    return fmt::format("gnuplot took longer than {} s", time_limit.count());
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return "gnuplot: " + last_line(log);
  return "";
}

// Moves the pictures from the private folder to their places. With SOURCE_DATE_EPOCH they show that
// time, so that two runs give the same bytes.
void move_pictures(const std::filesystem::path& folder, const std::filesystem::path& into) {
  const char* const epoch = std::getenv("SOURCE_DATE_EPOCH");
  for (const auto& entry : std::filesystem::directory_iterator(into)) {
    if (!entry.is_regular_file() || entry.path().filename() == "log") continue;
    std::ifstream file(entry.path(), std::ios::binary);
    std::string picture((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (epoch)
      set_creation_date(picture, static_cast<std::time_t>(std::strtoll(epoch, nullptr, 10)));
    replace_file((folder / entry.path().filename()).string(), picture);
  }
}

}  // namespace

// gnuplot draws into a private folder. Complete pictures replace the old ones only if the whole
// script succeeded.
std::string run_gnuplot(const std::string& folder, const std::string& script) {
  // gnuplot opens its pictures as any program does and follows links. In an empty folder of its
  // own there are no links.
  const std::string into = make_private_folder(folder);
  if (into.empty())
    return fmt::format("gnuplot has no folder to draw in ({})", std::strerror(errno));
  const std::filesystem::path drawn = std::filesystem::path(folder) / into;
  std::string problem = wait_for_gnuplot(folder, script, into);
  try {
    if (problem.empty()) move_pictures(folder, drawn);
  } catch (const Failure& failure) {
    problem = failure.what();
  }
  std::error_code ignored;
  std::filesystem::remove_all(drawn, ignored);
  return problem;
}

}  // namespace langer
