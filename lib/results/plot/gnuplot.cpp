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
#include "core/hdf5/seal.hpp"
#include "results/plot/figure_style.hpp"

namespace langer {

namespace {

constexpr std::array colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                             "#E69F00", "#56B4E9", "#000000"};
constexpr std::array markers{7, 5, 8, 10, 12, 6, 4};
constexpr std::array open_markers{6, 4, 8, 10, 12};
constexpr std::array dashes{1, 1, 2, 2,
                            4, 4, 5};  // of two curves that coincide both colours are seen
constexpr int most_markers = 25;       // on a line
constexpr std::chrono::seconds longest{120};

// the end of a file, for messages
std::string last_line(const std::string& path) {
  std::ifstream file(path);
  std::string last;
  for (std::string line; std::getline(file, line);)
    if (line.find_first_not_of(" \t^") != std::string::npos) last = line;
  return last;
}

// spaces that stay: SVG viewers drop a space beside a subscript
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
  const bool plain = !name.empty() && (std::isalnum(static_cast<unsigned char>(name[0])) ||
                                       std::strchr("_./", name[0]));
  return gnuplot_string(plain ? name : "./" + name);
}

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

double small(const FigureStyle& style) {
  return 0.86 * style.points();
}  // of words within a figure

// what `plot` draws of one line: a band, the line itself, bars and names
std::string pieces_of(const Plot& plot, const PlotLine& line, std::size_t i,
                      const FigureStyle& style) {
  const int every = std::max(1, (plot.rows + most_markers - 1) / most_markers);
  std::size_t colour = 0;
  if (line.colour < 0) {
    colour = i;
  } else {
    colour = static_cast<std::size_t>(line.colour);
  }
  // lines beyond the last colour begin with other dashes
  std::size_t dash = 0;
  if (line.dash < 0) {
    dash = i + i / colours.size();
  } else {
    dash = static_cast<std::size_t>(line.dash) * 2;
  }
  const char* const rgb = colours[colour % colours.size()];
  const std::string file = gnuplot_file(line.csv);
  const std::string x = gnuplot_string(line.x);
  const std::string y = gnuplot_string(line.y);
  std::string s;
  if (!line.error.empty())
    s += fmt::format(
        "{0} using (column({1})):(column({2})-column({3})):(column({2})+column({3})) with filledcurves fs transparent solid 0.2 "
        "noborder lc rgb '{4}' notitle, \\\n     ",
        file, x, y, gnuplot_string(line.error), rgb);
  s += fmt::format("{} using {}:{}", file, x, y);
  if (line.points)
    s += fmt::format(" every {} with points lw 1.5 lc rgb '{}' pt {} ps 1.3", every, rgb,
                     open_markers[dash % open_markers.size()]);
  else
    s += fmt::format(" with linespoints lw 2 lc rgb '{}' dt {} pt {} ps 0.6 pi {}", rgb,
                     dashes[dash % dashes.size()], markers[dash % markers.size()], every);
  s += fmt::format(" title {}",
                   printed(line.values ? with_decimal(line.legend, style.decimal) : line.legend));
  if (!line.low.empty())
    s +=
        fmt::format(", \\\n     {} using {}:{}:{}:{} with yerrorbars lw 1 lc rgb '{}' pt 0 notitle",
                    file, x, y, gnuplot_string(line.low), gnuplot_string(line.high), rgb);
  if (!line.names.empty())
    s += fmt::format(
        ", \\\n     {} using {}:{}:{} with labels noenhanced left offset 0.6,0.4 font ',{:.3g}' tc rgb '#555555' notitle",
        file, x, y, gnuplot_string(line.names), small(style));
  return s;
}

std::string frame_of(const Plot& plot, const FigureStyle& style) {
  std::string s = "set encoding utf8\nset datafile separator comma\nset datafile columnheaders\n";
  if (style.decimal == DecimalSign::comma) s += "set decimalsign ','\n";
  s +=
      "set border 3 lw 1.2\nset tics nomirror out scale 0.7\nset grid lt 1 lw 0.5 lc rgb '#d8d8d8'\n";
  s += "set key outside center top horizontal reverse Left samplen 3\n";
  if (plot.lines.size() == 1) s += "unset key\n";
  if (!plot.title.empty() && style.titles) s += fmt::format("set title {}\n", printed(plot.title));
  s += fmt::format("set xlabel {}\nset ylabel {}\n", printed(plot.x_label), printed(plot.y_label));
  if (plot.scale != AxisScale::linear)
    s += fmt::format("set logscale {}\n", plot.scale == AxisScale::log     ? "xy"
                                          : plot.scale == AxisScale::log_x ? "x"
                                                                           : "y");
  if (plot.x_step > 0) s += fmt::format("set xtics {}\n", plot.x_step);
  if (plot.y_most) s += fmt::format("set yrange [*:*<{:g}]\n", *plot.y_most);
  for (const PlotMark& mark : plot.marks)
    s += fmt::format(
        "set arrow from graph 0, first {0:g} to graph 1, first {0:g} nohead dt 2 lc rgb '#555555'\n"
        "set label {1} at graph 0.99, first {0:g} right offset 0,0.6 font ',{2:.3g}' tc rgb '#555555'\n",
        mark.y, printed(with_decimal(mark.text, style.decimal)), small(style));
  if (plot.notes.empty()) return s;
  s += "set rmargin at screen 0.66\n";
  const double step = std::min(0.052, 0.84 / static_cast<double>(plot.notes.size()));
  for (std::size_t i = 0; i < plot.notes.size(); ++i)
    s += fmt::format(
        "set label {} at screen 0.68,{:.4f} noenhanced font ',{:.3g}' tc rgb '#333333'\n",
        printed(with_decimal(plot.notes[i], style.decimal)), 0.88 - step * static_cast<double>(i),
        small(style));
  return s;
}

// A label whose unit takes a factor, as a gnuplot expression of its exponent e: energy (N mm)
// becomes energy (10^{-4} N mm).
std::string with_factor(const std::string& label, bool is_unit) {
  std::size_t unit = std::string::npos;
  if (label.ends_with(')')) unit = label.rfind('(');
  const std::string factor = " . sprintf('10^{%d}', e) . ";
  if (is_unit) return "''" + factor + printed(" " + label);
  if (unit == std::string::npos) return printed(label + " (") + factor + "')'";
  return printed(label.substr(0, unit + 1)) + factor + printed(" " + label.substr(unit + 1));
}

// gnuplot writes 0.0001 beside 5×10^{-5} on one axis, and 800000 beside 10^6. Only after a plot
// does it know the ends of an axis, which therefore is drawn once for nobody; one with such numbers
// then takes a common factor. All others stay as gnuplot makes them.
std::string factors_of(const Plot& plot, const std::string& draw) {
  const bool x =
      plot.x_step == 0 && (plot.scale == AxisScale::linear || plot.scale == AxisScale::log_y);
  const bool y = plot.scale == AxisScale::linear || plot.scale == AxisScale::log_x;
  if (!x && !y) return "";
  std::string s =
      "# an axis that gnuplot would number as 0.0001 beside 5x10^{-5}, or 800000 beside 10^6, takes a common factor\n";
  s += "set terminal dumb\nset output '/dev/null'\n" + draw + "\n";
  s +=
      "mixed(a, b) = a < b && (a <= -1e6 || b >= 1e6 || (b - a < 5.6e-4 && a < 1e-4 && b > -1e-4))\n";
  s += "step(r, p) = p * (r < 1.01 * p ? 0.1 : r < 2.01 * p ? 0.2 : r < 4.99 * p ? 0.5 : 1)\n";
  for (const char axis : {'x', 'y'}) {
    if (!(axis == 'x' ? x : y)) continue;
    s += fmt::format(
        "a = GPVAL_{0}_MIN; b = GPVAL_{0}_MAX\n"
        "if (mixed(a, b)) {{\n"
        "  e = floor(log10(b > -a ? b : -a) + 1e-9)\n"
        "  s = step(b - a, 10**floor(log10(b - a) + 1e-9))\n"
        "  set {1}range [a:b]\n"
        "  set {1}label {2}\n"
        "  set {1}tics ()\n"
        "  do for [k = ceil(a / s - 1e-6) : floor(b / s + 1e-6)] {{ set {1}tics add (gprintf('%.8g', k * s / 10.0**e) k * s) }}\n"
        "}}\n",
        static_cast<char>(axis - 'x' + 'X'), axis,
        axis == 'x' ? with_factor(plot.x_label, false)
                    : with_factor(plot.y_label, plot.y_label_is_unit));
  }
  return s;
}

// one for the screen: sizes that were there before papers were thought of
std::string terminal_of(PictureFormat format, const FigureStyle& style) {
  const double inches = style.width_mm() / 25.4;
  double tall = 0;
  if (style.height) {
    tall = *style.height / 25.4;
  } else {
    tall = inches / 1.5;
  }
  const double points = style.points();
  const double thick = points / 10.5;
  const double pixels = style.dpi / 96.0;
  const std::string font = gnuplot_string(
      fmt::format("{},{:.4g}", style.font, format == PictureFormat::svg ? points / 0.75 : points));
  switch (format) {
    case PictureFormat::svg:
      return fmt::format(
          "svg enhanced size {:.0f},{:.0f} {} font {} linewidth {:.3g} background rgb 'white'",
          96 * inches, 96 * tall, style.on_paper() ? "fixed" : "dynamic", font, thick);
    case PictureFormat::png:
      if (style.on_paper())
        return fmt::format(
            "pngcairo enhanced size {:.0f},{:.0f} font {} fontscale {:.4g} linewidth {:.4g} pointscale {:.4g} background rgb 'white'",
            style.dpi * inches, style.dpi * tall, font, pixels, pixels * thick, pixels * thick);
      return fmt::format(
          "pngcairo enhanced size {:.0f},{:.0f} font {} fontscale {:g} linewidth {:g} pointscale {:g} background rgb 'white'",
          style.dpi * inches, style.dpi * tall, gnuplot_string(style.font + ",13"), pixels, pixels,
          pixels);
    default:
      return fmt::format(
          "{}cairo enhanced size {:.4f}in,{:.4f}in font {} linewidth {:.3g} pointscale {:.3g}",
          names(format)[static_cast<std::size_t>(format)], inches, tall, font, thick, 0.75 * thick);
  }
}

}  // namespace

std::string gnuplot_script(const Plot& plot, const std::string& name, const FigureStyle& style) {
  std::string s = fmt::format("# made by langer; run again with: gnuplot {}.gp\n", name) +
                  frame_of(plot, style);
  std::string draw = "plot ";
  for (std::size_t i = 0; i < plot.lines.size(); ++i)
    draw += (i ? ", \\\n     " : "") + pieces_of(plot, plot.lines[i], i, style);
  s += factors_of(plot, draw);
  for (PictureFormat format : style.formats)
    s += fmt::format("set terminal {}\n{}{}\n", terminal_of(format, style),
                     gnuplot_output(name + "." + names(format)[static_cast<std::size_t>(format)]),
                     draw);
  return s + "unset output\n";
}

std::string gnuplot_output(const std::string& file) {
  return fmt::format("if (!exists('into')) into = ''\nset output into.{}\n", gnuplot_file(file));
}

namespace {

// The lines "/CreationDate (D:20260131120000Z)" of a PDF and "%%CreationDate: Sat Jan 31 12:00:00
// 2026" of an EPS. Cairo takes the time of day for them; both have a fixed length, so another time
// may be written over them without moving a byte.
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
// complaints to a log there. Returns what went wrong.
std::string wait_for_gnuplot(const std::string& folder, const std::string& script,
                             const std::string& into) {
  const std::string log = (std::filesystem::path(folder) / into / "log").string();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  const int log_flags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW;
  posix_spawn_file_actions_addopen(&actions, 2, log.c_str(), log_flags, 0644);
  posix_spawn_file_actions_addchdir_np(&actions, folder.empty() ? "." : folder.c_str());

  // The signals that this program ignores are gnuplot's own business.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t usual;
  sigemptyset(&usual);
  sigaddset(&usual, SIGPIPE);
  sigaddset(&usual, SIGXFSZ);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);

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

  int status = 0;
  pid_t ended = 0;
  const auto deadline = std::chrono::steady_clock::now() + longest;
  while (ended == 0 && std::chrono::steady_clock::now() < deadline) {
    ended = waitpid(child, &status, WNOHANG);
    if (ended == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (ended == 0) {
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    return fmt::format("gnuplot took longer than {} s", longest.count());
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

std::string run_gnuplot(const std::string& folder, const std::string& script) {
  // gnuplot opens its pictures as any program does, through links. It gets an empty folder of its
  // own, where none can lie.
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
