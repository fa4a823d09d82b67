#include "results/post/render.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {

constexpr double margin = 24;
constexpr int most_patches = 6000;
const Colour ink{0.13, 0.13, 0.13}, steel{0.80, 0.82, 0.85}, paper{0.93, 0.92, 0.89},
    grey{0.45, 0.47, 0.50}, vermilion{0.835, 0.369, 0}, blue{0, 0.447, 0.698};

// A part of the picture. Items farther from the eye are painted first.
struct Item {
  double depth = 0;
  std::vector<std::variant<Patch, Stroke, Label>> marks;
};

// The eye's axes as rows: right, up, towards the eye.
Mat3 eye(const std::array<double, 2>& view) {
  const double a = view[0] * std::numbers::pi / 180;
  const double e = view[1] * std::numbers::pi / 180;
  Mat3 R;
  R << std::cos(a), 0, -std::sin(a),                                        //
      -std::sin(e) * std::sin(a), std::cos(e), -std::sin(e) * std::cos(a),  //
      std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a);
  return R;
}

// Light from above, left and in front of the eye. The shadow side keeps enough of its colour to
// be readable.
double light(const Vec3& n) { return std::max(0.0, n.dot(Vec3(-0.35, 0.80, 0.49).normalized())); }
double shade(const Vec3& n) { return 0.74 + 0.26 * light(n); }

// From positions in the eye's axes to the page.
struct Page {
  double scale = 1, left = 0, top = 0;  // [pt/mm], page position of (0, 0)
  PagePoint operator()(const Vec3& seen) const {
    return {left + scale * seen[0], top - scale * seen[1]};
  }
};

// The unit normal of a polygon by Newell's sum, which also works for polygons that are not plane.
Vec3 normal_of(const std::vector<Vec3>& corners) {
  Vec3 n = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i)
    n += corners[i].cross(corners[(i + 1) % corners.size()]);
  return n.normalized();
}

double mean_depth(const std::vector<Vec3>& corners) {
  double sum = 0;
  for (const Vec3& c : corners) sum += c[2];
  return sum / static_cast<double>(corners.size());
}

// Draws the colour bar at the right of the picture, with its label above and the axes below it.
void add_colour_bar(Drawing& drawing, double title_room, double low, double high,
                    const std::string& label, double bar_room, ColourMap colours) {
  constexpr int bands = 128;
  const double x = drawing.width - bar_room + 30;
  const double width = 22;
  const double height = std::min(300.0, drawing.height - title_room - 190);
  const double top = title_room + (drawing.height - title_room - height - 100) / 2;
  for (int i = 0; i < bands; ++i) {
    // Each band reaches down to the end of the bar, so that no seams are seen.
    const double y0 = top + height * i / bands;
    const double y1 = top + height;
    drawing.marks.push_back(Patch{{{x, y0}, {x + width, y0}, {x + width, y1}, {x, y1}},
                                  scale_colour(1 - (i + 0.5) / bands, colours)});
  }
  drawing.marks.push_back(
      Stroke{{{x, top}, {x + width, top}, {x + width, top + height}, {x, top + height}, {x, top}},
             ink,
             0.8});
  const std::vector<double> at = ticks(low, high);
  const std::vector<std::string> texts = tick_texts(at);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double y = top + height * (high - at[i]) / (high - low);
    drawing.marks.push_back(Stroke{{{x + width, y}, {x + width + 5, y}}, ink, 0.8});
    drawing.marks.push_back(Label{{x + width + 9, y + 4.5}, texts[i], 13});
  }
  double label_room = drawing.width;
  if (bar_room < 150) label_room = bar_room + 40;  // a narrow page
  add_lines_above(drawing, {drawing.width - margin, top - 16}, label, 14, label_room);
}

// Draws the directions of x, y and z in the lower right corner.
void add_axes(Drawing& drawing, const Mat3& R, double bar_room) {
  const PagePoint origin{drawing.width - bar_room + 60, drawing.height - margin - 36};
  for (int i = 0; i < 3; ++i) {
    const Vec3 seen = R.col(i);
    drawing.marks.push_back(
        Stroke{{origin, {origin[0] + 36 * seen[0], origin[1] - 36 * seen[1]}}, ink, 1.4});
    drawing.marks.push_back(Label{{origin[0] + 48 * seen[0], origin[1] - 48 * seen[1] + 5},
                                  names(CutNormal{})[i],
                                  14,
                                  Label::Anchor::middle});
  }
}

// Edges at which the normal of the surface turns by more than 40 degrees, and edges of its
// border.
std::vector<std::array<int, 2>> sharp_edges(const std::vector<std::array<int, 4>>& surface,
                                            const std::vector<Vec3>& x) {
  std::map<std::array<int, 2>, std::vector<Vec3>> normals;
  for (const auto& q : surface) {
    const Vec3 n = normal_of({x[q[0]], x[q[1]], x[q[2]], x[q[3]]});
    for (int k = 0; k < 4; ++k) {
      std::array<int, 2> edge{q[k], q[(k + 1) % 4]};
      std::sort(edge.begin(), edge.end());
      normals[edge].push_back(n);
    }
  }
  std::vector<std::array<int, 2>> edges;
  for (const auto& [edge, n] : normals)
    if (n.size() != 2 || n[0].dot(n[1]) < 0.766) edges.push_back(edge);
  return edges;
}

// An arrow on the page: a line and a triangle.
void add_arrow(Drawing& drawing, const PagePoint& from, const PagePoint& to, const Colour& colour) {
  const double dx = to[0] - from[0];
  const double dy = to[1] - from[1];
  const double length = std::max(std::hypot(dx, dy), 1e-9);
  const double head = std::min(11.0, length);
  const double ex = dx / length;
  const double ey = dy / length;
  const PagePoint neck{to[0] - head * ex, to[1] - head * ey};
  drawing.marks.push_back(Stroke{{from, neck}, colour, 2});
  drawing.marks.push_back(Patch{{to,
                                 {neck[0] - 0.45 * head * ey, neck[1] + 0.45 * head * ex},
                                 {neck[0] + 0.45 * head * ey, neck[1] - 0.45 * head * ex}},
                                colour});
}

// The ends of an arrow at a node. Its length is a fraction of the size of the body: a movement
// starts at the node, a support ends there.
std::pair<Vec3, Vec3> arrow_of(const Action& action, const Vec3& at, double size) {
  if (action.moves) return {at, at + 0.17 * size * action.along};
  return {at - 0.07 * size * action.along, at};
}

// Marks the named points with a dot and their name.
void add_points(Drawing& drawing, const RenderScene& scene, const Mat3& R, const Page& page) {
  for (const auto& [name, x] : scene.points) {
    const PagePoint at = page(R * x);
    for (const auto& [radius, colour] : {std::pair{5.5, Colour{1, 1, 1}}, {4.0, vermilion}}) {
      std::vector<PagePoint> round;
      for (int k = 0; k < 20; ++k)
        round.push_back({at[0] + radius * std::cos(k * std::numbers::pi / 10),
                         at[1] + radius * std::sin(k * std::numbers::pi / 10)});
      drawing.marks.push_back(Patch{round, colour});
    }
    // The name is black on white, so that it can be read on any ground.
    drawing.marks.push_back(
        Patch{{{at[0] + 6, at[1] - 6},
               {at[0] + 9 + 11.0 * static_cast<double>(name.size()), at[1] - 6},
               {at[0] + 9 + 11.0 * static_cast<double>(name.size()), at[1] - 24},
               {at[0] + 6, at[1] - 24}},
              Colour{1, 1, 1}});
    drawing.marks.push_back(Label{{at[0] + 8, at[1] - 9}, name, 16});
  }
}

// A label at the left of its arrow ends there, one at the right begins there.
Label::Anchor anchor_beyond(double to_the_right) {
  if (to_the_right > 0.3) return Label::Anchor::start;
  if (to_the_right < -0.3) return Label::Anchor::end;
  return Label::Anchor::middle;
}

// The end of an action's arrow that is away from the body.
Vec3 outer_end(const Action& action, const Vec3& at, double size) {
  const auto [from, to] = arrow_of(action, at, size);
  if (action.moves) return to;
  return from;
}

// Draws the arrows of supports (blue) and movements (vermilion). The label of an action is at its
// arrow closest to the eye.
void add_actions(Drawing& drawing, const RenderScene& scene, const Mat3& R, const Page& page,
                 double size) {
  for (const Action& action : scene.actions) {
    const Colour& colour = action.moves ? vermilion : blue;
    Vec3 end = Vec3::Zero();
    double closest = -std::numeric_limits<double>::infinity();
    for (const Vec3& x : action.at) {
      const auto [from, to] = arrow_of(action, x, size);
      add_arrow(drawing, page(R * from), page(R * to), colour);
      if ((R * x)[2] > closest) {
        closest = (R * x)[2];
        end = outer_end(action, x, size);
      }
    }
    Vec3 outwards = action.along;
    if (!action.moves) outwards = -action.along;
    const PagePoint at = page(R * Vec3(end + 0.035 * size * outwards));
    const Label::Anchor anchor = anchor_beyond((R * outwards)[0]);
    drawing.marks.push_back(Label{{at[0], at[1] + 5}, action.says, 16, anchor, true});
  }
}

}  // namespace

std::vector<Complaint> RenderChoice::complaints() const {
  std::vector<Complaint> found;
  if (field && !is_field(line_of(*field)))
    found.push_back(
        {"field", line_of(*field).word, "a quantity of nodes or points, as u_y or von_mises", ""});
  if (range && !((*range)[0] < (*range)[1]))
    found.push_back({"range", "its ends are not ascending", "[low, high]", ""});
  if (critical && mode)
    found.push_back({"critical", "found together with mode", "one of the two", ""});
  return found;
}

// Counts the kept elements at each facet: a facet of one element is on the surface.
std::vector<std::array<int, 4>> outer_surface(const Mesh& mesh, const std::vector<bool>& kept) {
  // For each facet the number of its elements and the last of them.
  std::map<std::array<int, 4>, std::pair<int, Facet>> seen;
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int f = 0; kept[e] && f < mesh.cell().n_facets(); ++f) {
      auto& entry = seen[facet_key(mesh, {e, f})];
      ++entry.first;
      entry.second = {e, f};
    }
  std::vector<std::array<int, 4>> surface;
  for (const auto& [key, entry] : seen) {
    if (entry.first != 1) continue;
    const auto quads = facet_quads(mesh, entry.second);
    surface.insert(surface.end(), quads.begin(), quads.end());
  }
  return surface;
}

namespace {

// Which elements are shown: those whose centre is on the kept side of all cuts.
std::vector<bool> cells_kept(const Mesh& mesh, const std::vector<Cut>& cuts) {
  std::vector<bool> kept(static_cast<std::size_t>(mesh.n_cells()), true);
  for (const Cut& cut : cuts) {
    // A section is in a plane of constant z. Cutting it there would leave nothing.
    if (mesh.section && cut.axis == CutNormal::z) continue;
    for (int e = 0; e < mesh.n_cells(); ++e) {
      const double centre = element_nodes(mesh, e).col(static_cast<int>(cut.axis)).mean();
      if ((centre > cut.at) != (cut.keep == Side::above)) kept[e] = false;
    }
  }
  return kept;
}

// The outline of an indenter, cut open by the first plane that meets it.
OpenedOutline opened(const Outline& outline, const std::vector<Cut>& cuts) {
  for (const Cut& cut : cuts) {
    const int axis = static_cast<int>(cut.axis);
    const auto below = [&](const Vec3& x) {
      return x[axis] < cut.at;
    };
    const auto n = std::count_if(outline.points.begin(), outline.points.end(), below);
    if (n == 0 || n == static_cast<std::ptrdiff_t>(outline.points.size())) continue;
    const int side = cut.keep == Side::above ? 1 : -1;
    return cut_open(outline, axis, cut.at, side);
  }
  return {outline, {}};
}

// The face between the profile of a plate and its highest point, seen from the front. The plate is
// solid there.
std::vector<Vec3> solid_above(const Outline& outline, const std::vector<int>& profile) {
  std::vector<Vec3> corners;
  for (int point : profile) corners.push_back(outline.points[point]);
  const Vec3 begin = corners.front();
  const Vec3 end = corners.back();
  if (begin[0] > end[0]) {
    corners.emplace_back(begin[0], end[1], begin[2]);
  } else {
    corners.emplace_back(end[0], begin[1], end[2]);
  }
  if (normal_of(corners)[2] < 0) std::ranges::reverse(corners);
  return corners;
}

// Removes the lines that have no point beyond x.
void erase_lines_up_to(double x, Outline& outline) {
  std::erase_if(outline.lines, [&](const std::vector<int>& line) {
    return std::ranges::all_of(line, [&](int point) { return outline.points[point][0] <= x; });
  });
}

// The outline of an indenter of a section. A plate with a hole encloses no volume, and its wall
// would stand next to the body and in front of it. It is cut along the section and at the axis y,
// which leaves the line of its profile and the part of its wall behind that.
OpenedOutline opened_along(const Section& section, const Outline& outline) {
  Eigen::AlignedBox3d box;
  for (const Vec3& x : outline.points) box.extend(x);
  const double aside = 1e-9 * box.diagonal().norm();  // of the plane, which goes through corners
  OpenedOutline behind = cut_open(outline, 2, -aside, -1);
  const bool has_hole = behind.cap.faces.empty() && !behind.kept.lines.empty();
  if (!has_hole) return {outline, {}};
  if (section.of != SectionOf::axisymmetric) return behind;
  erase_lines_up_to(aside, behind.kept);  // the profile on the other side of the axis
  OpenedOutline right = cut_open(behind.kept, 0, aside, 1);
  erase_lines_up_to(aside, right.kept);  // where the axis cuts the wall
  for (const std::vector<int>& profile : right.kept.lines) {
    add_face(right.cap, solid_above(right.kept, profile));
  }
  right.kept.lines.clear();
  return right;
}

// Everything that is painted, in the eye's axes.
struct Seen {
  struct Quad {
    std::array<int, 4> nodes;
    std::vector<Vec3> corners;
  };
  Mat3 R;
  std::vector<Quad> quads;  // of the body, those that face the eye
  std::vector<OpenedOutline> indenters;
  std::vector<std::array<int, 2>> outline;  // of the undeformed body
  Eigen::AlignedBox3d box;
  double extent = 1;
  // The range of the field in the visible quads.
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  bool coloured = false;
};

// Turns the outlines of the indenters into the eye's axes, cut open by the planes of the config.
void look_at_indenters(const RenderScene& scene, const RenderChoice& choice, Seen& seen) {
  for (const Outline& indenter : scene.indenters) {
    OpenedOutline& part = seen.indenters.emplace_back(opened(indenter, choice.cuts));
    if (scene.mesh.section && choice.cuts.empty())
      part = opened_along(*scene.mesh.section, indenter);
    for (Outline* outline : {&part.kept, &part.cap})
      for (Vec3& x : outline->points) {
        x = seen.R * x;
        seen.box.extend(x);
      }
  }
}

// A section is seen from the front, a body from above.
std::array<double, 2> default_view(const Mesh& mesh) {
  if (mesh.section) return {0, 0};
  return {35, 28};
}

// Finds what the eye sees: the quads of the surface that face it, indenters, outline and arrows,
// with their common bounding box and the range of the colours.
Seen look_at(const RenderScene& scene, const RenderChoice& choice) {
  const Mesh& mesh = scene.mesh;
  Seen seen;
  seen.R = eye(choice.view.value_or(default_view(mesh)));
  const Mat3& R = seen.R;
  std::vector<Vec3> x;
  for (const Vec3& place : scene.x) x.push_back(R * place);
  for (const auto& nodes : outer_surface(mesh, cells_kept(mesh, choice.cuts))) {
    const std::vector<Vec3> corners{x[nodes[0]], x[nodes[1]], x[nodes[2]], x[nodes[3]]};
    for (const Vec3& c : corners) seen.box.extend(c);
    if (normal_of(corners)[2] <= 0) continue;
    if (!scene.values.empty())
      for (int node : nodes) {
        seen.low = std::min(seen.low, scene.values[node]);
        seen.high = std::max(seen.high, scene.values[node]);
      }
    seen.quads.push_back({nodes, corners});
  }
  look_at_indenters(scene, choice, seen);
  if (choice.outline) {
    seen.outline = sharp_edges(
        outer_surface(mesh, std::vector<bool>(static_cast<std::size_t>(mesh.n_cells()), true)),
        mesh.X);
    for (const auto& edge : seen.outline)
      for (int node : edge) seen.box.extend(Vec3(R * mesh.X[node]));
  }
  if (!seen.box.isEmpty()) seen.extent = seen.box.sizes().norm();
  // The picture has room for the arrows and for their labels on both sides.
  for (const Action& action : scene.actions)
    for (const Vec3& at : action.at) {
      const Vec3 far = R * outer_end(action, at, seen.extent);
      const Vec3 label(0.11 * seen.extent, 0.04 * seen.extent, 0);
      seen.box.extend(far);
      seen.box.extend(far + label);
      seen.box.extend(far - label);
    }
  if (choice.range) {
    seen.low = (*choice.range)[0];
    seen.high = (*choice.range)[1];
  }
  // If no quad is visible, there is no range of values.
  seen.coloured = !scene.values.empty() && seen.low <= seen.high;
  if (!(seen.high - seen.low > 1e-12 * std::max(std::abs(seen.low), std::abs(seen.high)))) {
    // The values are equal. A scale needs a width.
    seen.low -= 0.5;
    seen.high += 0.5;
  }
  return seen;
}

// Adds the quads of the body. Each is divided into m x m parts of one colour, fewer if there are
// many quads.
void paint_body(const RenderScene& scene, const Seen& seen, const Page& page, ColourMap colours,
                std::vector<Item>& items) {
  const int m = std::clamp(
      static_cast<int>(std::sqrt(most_patches / std::max<double>(1, seen.quads.size()))), 1, 6);
  for (const Seen::Quad& quad : seen.quads) {
    Item item{mean_depth(quad.corners), {}};
    // A quad has one shade; the field varies bilinearly within it.
    const double s = shade(normal_of(quad.corners));
    const auto weights = [](double p, double q) {
      return std::array{(1 - p) * (1 - q), p * (1 - q), p * q, (1 - p) * q};
    };
    const auto at = [&](double p, double q) {
      const auto N = weights(p, q);
      Vec3 x = Vec3::Zero();
      for (int k = 0; k < 4; ++k) x += N[k] * quad.corners[k];
      return page(x);
    };
    const auto colour_at = [&](double p, double q) {
      if (!seen.coloured) return shaded(paper, s);
      const auto N = weights(p, q);
      double value = 0;
      for (int k = 0; k < 4; ++k) value += N[k] * scene.values[quad.nodes[k]];
      return shaded(scale_colour((value - seen.low) / (seen.high - seen.low), colours), s);
    };
    // The whole quad is painted below its parts, so that the page is not seen between them.
    item.marks.push_back(Patch{{at(0, 0), at(1, 0), at(1, 1), at(0, 1)}, colour_at(0.5, 0.5)});
    for (int i = 0; i < m && m > 1 && seen.coloured; ++i)
      for (int j = 0; j < m; ++j) {
        const double p0 = double(i) / m;
        const double p1 = double(i + 1) / m;
        const double q0 = double(j) / m;
        const double q1 = double(j + 1) / m;
        item.marks.push_back(Patch{{at(p0, q0), at(p1, q0), at(p1, q1), at(p0, q1)},
                                   colour_at((p0 + p1) / 2, (q0 + q1) / 2)});
      }
    item.marks.push_back(Stroke{{at(0, 0), at(1, 0), at(1, 1), at(0, 1), at(0, 0)}, ink, 0.7, 0.8});
    items.push_back(std::move(item));
  }
}

// Adds the faces of an indenter that face the eye, the faces of a cut, and lines of its outline.
void paint_indenter(const OpenedOutline& indenter, const Page& page, std::vector<Item>& items) {
  const auto at = [](const Outline& outline, const std::vector<int>& line) {
    std::vector<Vec3> corners;
    for (int p : line) corners.push_back(outline.points[p]);
    return corners;
  };
  const auto on_page = [&](const std::vector<Vec3>& corners) {
    std::vector<PagePoint> points;
    for (const Vec3& corner : corners) points.push_back(page(corner));
    return points;
  };
  for (const auto& face : indenter.kept.faces) {
    const std::vector<Vec3> corners = at(indenter.kept, face);
    const Vec3 n = normal_of(corners);
    if (n[2] > 0)
      items.push_back({mean_depth(corners),
                       {Patch{on_page(corners), shaded(steel, 0.35 + 0.65 * light(n)), 0.5}}});
  }
  for (const auto& face : indenter.cap.faces) {
    const std::vector<Vec3> corners = at(indenter.cap, face);
    if (normal_of(corners)[2] <= 0) continue;
    std::vector<PagePoint> border = on_page(corners);
    border.push_back(border.front());
    items.push_back(
        {mean_depth(corners), {Patch{border, Colour{0.88, 0.89, 0.91}}, Stroke{border, ink, 0.8}}});
  }
  for (const auto& line : indenter.kept.lines) {
    const std::vector<Vec3> points = at(indenter.kept, line);
    items.push_back({mean_depth(points), {Stroke{on_page(points), grey, 1}}});
  }
}

}  // namespace

// The body is scaled to the page, painted from back to front, and then annotated: outline,
// arrows, points, colour bar and axes are never hidden.
Drawing render(const RenderScene& scene, const RenderChoice& choice, const Look& look) {
  const Seen seen = look_at(scene, choice);
  const bool titled = look.titles && !choice.title.empty();
  double title_room = 0;
  if (titled) title_room = 40;
  const double page_width = look.width.value_or(960);
  double bar_room = 150;
  if (page_width < 500) bar_room = 118;
  const double room = page_width - bar_room - 2 * margin;
  const double tallest = page_width / 1.5;
  Vec3 size(1, 1, 1);
  Vec3 middle(0, 0, 0);
  if (!seen.box.isEmpty()) {
    size = seen.box.sizes();
    middle = seen.box.center();
  }
  Page page;
  page.scale = std::min(room / size[0], tallest / size[1]);
  Drawing drawing;
  drawing.width = page_width;
  drawing.height = std::round(
      std::max(std::min(400.0, 0.8 * page_width), page.scale * size[1] + 2 * margin + title_room));
  page.left = margin + room / 2 - page.scale * middle[0];
  page.top = title_room + (drawing.height - title_room) / 2 + page.scale * middle[1];

  // Body and indenters hide each other, so they are sorted by depth together.
  std::vector<Item> items;
  paint_body(scene, seen, page, look.colours, items);
  for (const OpenedOutline& indenter : seen.indenters) paint_indenter(indenter, page, items);
  std::ranges::stable_sort(items, {}, &Item::depth);
  for (Item& item : items)
    std::move(item.marks.begin(), item.marks.end(), std::back_inserter(drawing.marks));
  for (const auto& edge : seen.outline)
    drawing.marks.push_back(Stroke{
        {page(seen.R * scene.mesh.X[edge[0]]), page(seen.R * scene.mesh.X[edge[1]])}, grey, 1.3});
  add_actions(drawing, scene, seen.R, page, seen.extent);
  add_points(drawing, scene, seen.R, page);
  if (seen.coloured)
    add_colour_bar(drawing, title_room, seen.low, seen.high, scene.label, bar_room, look.colours);
  add_axes(drawing, seen.R, bar_room);
  if (titled) {
    Label title{{page_width / 2, margin + 12}, choice.title, 17, Label::Anchor::middle};
    title.own = true;
    drawing.marks.push_back(title);
  }
  return drawing;
}

}  // namespace langer
