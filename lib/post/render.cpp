#include "post/render.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "mesh/facets.hpp"
#include "mesh/reference.hpp"

namespace langer {

namespace {

constexpr double page_width = 960, margin = 24, bar_room = 150;
constexpr int most_patches = 6000;
const Colour ink{0.13, 0.13, 0.13}, steel{0.80, 0.82, 0.85}, paper{0.93, 0.92, 0.89}, grey{0.45, 0.47, 0.50},
    vermilion{0.835, 0.369, 0}, blue{0, 0.447, 0.698};

// One thing to paint; those further from the eye come first.
struct Item {
  double depth = 0;
  std::vector<std::variant<Patch, Stroke, Label>> marks;
};

// The eye's axes as rows: right, up, towards the eye.
Mat3 eye(const std::array<double, 2>& view) {
  const double a = view[0] * std::numbers::pi / 180, e = view[1] * std::numbers::pi / 180;
  Mat3 R;
  R << std::cos(a), 0, -std::sin(a),                                        //
      -std::sin(e) * std::sin(a), std::cos(e), -std::sin(e) * std::cos(a),  //
      std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a);
  return R;
}

// light from above, left and in front of the eye; the shadow side keeps enough of its colour to be read
double light(const Vec3& n) { return std::max(0.0, n.dot(Vec3(-0.35, 0.80, 0.49).normalized())); }
double shade(const Vec3& n) { return 0.74 + 0.26 * light(n); }
Colour shaded(const Colour& c, double s) { return {c.r * s, c.g * s, c.b * s}; }

// Seen positions to the page.
struct Page {
  double scale = 1, left = 0, top = 0;  // [pt/mm], page position of (0, 0)
  PagePoint operator()(const Vec3& seen) const { return {left + scale * seen[0], top - scale * seen[1]}; }
};

// The sphere in patches between circles about `pole`, up to where a plane cuts it off, and last the disc in that plane.
std::vector<std::vector<Vec3>> ball_patches(const Ball& ball, const std::vector<Cut>& cuts) {
  constexpr int rings = 48, sectors = 96;
  const auto cut = std::find_if(cuts.begin(), cuts.end(),
                                [&](const Cut& c) { return std::abs(c.at - ball.centre[static_cast<int>(c.axis)]) < ball.radius; });
  const bool is_cut = cut != cuts.end();
  const int axis = is_cut ? static_cast<int>(cut->axis) : 1;
  const double side = is_cut && cut->keep == Side::above ? 1 : -1;
  Vec3 pole = Vec3::Zero();
  pole[axis] = side;
  const Vec3 s = Vec3::Unit((axis + 1) % 3), t = pole.cross(s);
  // angle from the pole at which the kept part ends
  const double end = is_cut ? std::acos(side * (cut->at - ball.centre[axis]) / ball.radius) : std::numbers::pi;
  const auto point = [&](int ring, int sector) {
    const double theta = end * ring / rings, phi = 2 * std::numbers::pi * sector / sectors;
    return Vec3(ball.centre + ball.radius * (std::cos(theta) * pole + std::sin(theta) * (std::cos(phi) * s + std::sin(phi) * t)));
  };
  std::vector<std::vector<Vec3>> patches;
  for (int ring = 0; ring < rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector)
      patches.push_back({point(ring, sector), point(ring + 1, sector), point(ring + 1, sector + 1), point(ring, sector + 1)});
  if (is_cut) {
    std::vector<Vec3> disc;
    for (int sector = sectors; sector > 0; --sector) disc.push_back(point(rings, sector));
    patches.push_back(disc);
  }
  return patches;
}

Vec3 normal_of(const std::vector<Vec3>& corners) {  // Newell's sum: also of polygons that are not plane
  Vec3 n = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) n += corners[i].cross(corners[(i + 1) % corners.size()]);
  return n.normalized();
}

double mean_depth(const std::vector<Vec3>& corners) {
  double sum = 0;
  for (const Vec3& c : corners) sum += c[2];
  return sum / static_cast<double>(corners.size());
}

void add_colour_bar(Drawing& drawing, double title_room, double low, double high, const std::string& label) {
  constexpr int bands = 128;
  // label above, the axes below
  const double x = page_width - bar_room + 30, width = 22, height = std::min(300.0, drawing.height - title_room - 190);
  const double top = title_room + (drawing.height - title_room - height - 100) / 2;
  for (int i = 0; i < bands; ++i) {
    // from the top, each down to the end: no seams
    const double y0 = top + height * i / bands, y1 = top + height;
    drawing.marks.push_back(Patch{{{x, y0}, {x + width, y0}, {x + width, y1}, {x, y1}}, scale_colour(1 - (i + 0.5) / bands)});
  }
  drawing.marks.push_back(Stroke{{{x, top}, {x + width, top}, {x + width, top + height}, {x, top + height}, {x, top}}, ink, 0.8});
  const std::vector<double> at = ticks(low, high);
  const std::vector<std::string> texts = tick_texts(at);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double y = top + height * (high - at[i]) / (high - low);
    drawing.marks.push_back(Stroke{{{x + width, y}, {x + width + 5, y}}, ink, 0.8});
    drawing.marks.push_back(Label{{x + width + 9, y + 4.5}, texts[i], 13});
  }
  drawing.marks.push_back(Label{{page_width - margin, top - 16}, label, 14, Label::Anchor::end, true});
}

void add_axes(Drawing& drawing, const Mat3& R) {
  const PagePoint origin{page_width - bar_room + 60, drawing.height - margin - 36};
  for (int i = 0; i < 3; ++i) {
    const Vec3 seen = R.col(i);
    drawing.marks.push_back(Stroke{{origin, {origin[0] + 36 * seen[0], origin[1] - 36 * seen[1]}}, ink, 1.4});
    drawing.marks.push_back(
        Label{{origin[0] + 48 * seen[0], origin[1] - 48 * seen[1] + 5}, names(CutNormal{})[i], 14, Label::Anchor::middle});
  }
}

// Edges where the surface turns by more than 40 degrees.
std::vector<std::array<int, 2>> sharp_edges(const std::vector<std::array<int, 4>>& surface, const std::vector<Vec3>& x) {
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

void add_arrow(Drawing& drawing, const PagePoint& from, const PagePoint& to, const Colour& colour) {
  const double dx = to[0] - from[0], dy = to[1] - from[1], length = std::max(std::hypot(dx, dy), 1e-9),
               head = std::min(11.0, length);
  const double ex = dx / length, ey = dy / length;
  const PagePoint neck{to[0] - head * ex, to[1] - head * ey};
  drawing.marks.push_back(Stroke{{from, neck}, colour, 2});
  drawing.marks.push_back(Patch{
      {to, {neck[0] - 0.45 * head * ey, neck[1] + 0.45 * head * ex}, {neck[0] + 0.45 * head * ey, neck[1] - 0.45 * head * ex}},
      colour});
}

// its ends, as long as a share of the body
std::pair<Vec3, Vec3> arrow_of(const Action& action, const Vec3& at, double size) {
  if (action.moves) return {at, at + 0.17 * size * action.along};
  return {at - 0.07 * size * action.along, at};
}

void add_points(Drawing& drawing, const RenderScene& scene, const Mat3& R, const Page& page) {
  for (const auto& [name, x] : scene.points) {
    const PagePoint at = page(R * x);
    for (const auto& [radius, colour] : {std::pair{5.5, Colour{1, 1, 1}}, {4.0, vermilion}}) {
      std::vector<PagePoint> round;
      for (int k = 0; k < 20; ++k)
        round.push_back(
            {at[0] + radius * std::cos(k * std::numbers::pi / 10), at[1] + radius * std::sin(k * std::numbers::pi / 10)});
      drawing.marks.push_back(Patch{round, colour});
    }
    // black on white, so that it is read on any ground
    drawing.marks.push_back(Patch{{{at[0] + 6, at[1] - 6},
                                   {at[0] + 9 + 11.0 * static_cast<double>(name.size()), at[1] - 6},
                                   {at[0] + 9 + 11.0 * static_cast<double>(name.size()), at[1] - 24},
                                   {at[0] + 6, at[1] - 24}},
                                  Colour{1, 1, 1}});
    drawing.marks.push_back(Label{{at[0] + 8, at[1] - 9}, name, 16});
  }
}

void add_actions(Drawing& drawing, const RenderScene& scene, const Mat3& R, const Page& page, double size) {
  for (const Action& action : scene.actions) {
    const Colour& colour = action.moves ? vermilion : blue;
    Vec3 end = Vec3::Zero();  // of the arrow nearest to the eye: there it says what
    double nearest = -std::numeric_limits<double>::infinity();
    for (const Vec3& x : action.at) {
      const auto [from, to] = arrow_of(action, x, size);
      add_arrow(drawing, page(R * from), page(R * to), colour);
      if ((R * x)[2] > nearest) nearest = (R * x)[2], end = action.moves ? to : from;
    }
    const Vec3 out = action.moves ? action.along : Vec3(-action.along);
    const PagePoint at = page(R * Vec3(end + 0.035 * size * out));
    const double side = (R * out)[0];
    drawing.marks.push_back(Label{{at[0], at[1] + 5},
                                  action.says,
                                  16,
                                  side > 0.3    ? Label::Anchor::start
                                  : side < -0.3 ? Label::Anchor::end
                                                : Label::Anchor::middle,
                                  true});
  }
}

}  // namespace

std::vector<Complaint> RenderChoice::complaints() const {
  std::vector<Complaint> found;
  if (field && !is_field(line_of(*field)))
    found.push_back({"field", line_of(*field).word, "a quantity of nodes or points, as u_y or von_mises", ""});
  if (range && !((*range)[0] < (*range)[1])) found.push_back({"range", "its ends are not ascending", "[low, high]", ""});
  return found;
}

std::vector<std::array<int, 4>> outer_surface(const Mesh& mesh, const std::vector<bool>& kept) {
  std::map<std::array<int, 4>, std::pair<int, Facet>> seen;  // how often, the last
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int f = 0; kept[e] && f < mesh.cell().n_facets(); ++f) {
      auto& entry = seen[facet_key(mesh, {e, f})];
      ++entry.first, entry.second = {e, f};
    }
  std::vector<std::array<int, 4>> surface;
  for (const auto& [key, entry] : seen) {
    if (entry.first != 1) continue;
    const auto quads = facet_quads(mesh, entry.second);
    surface.insert(surface.end(), quads.begin(), quads.end());
  }
  return surface;
}

Drawing render(const RenderScene& scene, const RenderChoice& choice) {
  const Mesh& mesh = scene.mesh;
  const Mat3 R = eye(choice.view.value_or(scene.mesh.section ? std::array{0., 0.} : std::array{35., 28.}));
  std::vector<bool> kept(static_cast<std::size_t>(mesh.n_cells()), true);
  for (const Cut& cut : choice.cuts)
    for (int e = 0; e < mesh.n_cells(); ++e) {
      const double centre = element_nodes(mesh, e).col(static_cast<int>(cut.axis)).mean();
      if ((centre > cut.at) != (cut.keep == Side::above)) kept[e] = false;
    }

  std::vector<Vec3> seen;
  for (const Vec3& x : scene.x) seen.push_back(R * x);
  struct Quad {
    std::array<int, 4> nodes;
    std::vector<Vec3> corners;
  };
  std::vector<Quad> quads;
  Eigen::AlignedBox3d box;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& nodes : outer_surface(mesh, kept)) {
    const std::vector<Vec3> corners{seen[nodes[0]], seen[nodes[1]], seen[nodes[2]], seen[nodes[3]]};
    for (const Vec3& c : corners) box.extend(c);
    if (normal_of(corners)[2] <= 0) continue;
    if (!scene.values.empty())
      for (int node : nodes) low = std::min(low, scene.values[node]), high = std::max(high, scene.values[node]);
    quads.push_back({nodes, corners});
  }
  std::vector<std::vector<Vec3>> ball;
  if (scene.ball) ball = ball_patches(*scene.ball, choice.cuts);
  for (auto& patch : ball)
    for (Vec3& corner : patch) corner = R * corner, box.extend(corner);
  std::vector<std::array<int, 2>> outline;
  if (choice.outline) {
    outline = sharp_edges(outer_surface(mesh, std::vector<bool>(kept.size(), true)), mesh.X);
    for (const auto& edge : outline)
      for (int node : edge) box.extend(Vec3(R * mesh.X[node]));
  }
  const double extent = box.isEmpty() ? 1 : box.sizes().norm();
  for (const Action& action : scene.actions)
    for (const Vec3& x : action.at) {
      const auto [from, to] = arrow_of(action, x, extent);
      const Vec3 far = R * Vec3(action.moves ? to : from), label(0.11 * extent, 0.04 * extent, 0);
      box.extend(far), box.extend(far + label), box.extend(far - label);
    }
  if (choice.range) low = (*choice.range)[0], high = (*choice.range)[1];
  const bool coloured = !scene.values.empty() && low <= high;  // nothing to be seen, no colour bar
  if (!(high - low > 1e-12 * std::max(std::abs(low), std::abs(high)))) low -= 0.5, high += 0.5;  // one value everywhere

  const double title_room = choice.title.empty() ? 0 : 40;
  const double room = page_width - bar_room - 2 * margin, tallest = 640;
  const Vec3 size = box.isEmpty() ? Vec3(1, 1, 1) : Vec3(box.sizes());
  Page page;
  page.scale = std::min(room / size[0], tallest / size[1]);
  Drawing drawing;
  drawing.width = page_width;
  drawing.height = std::round(std::max(400.0, page.scale * size[1] + 2 * margin + title_room));
  const Vec3 middle = box.isEmpty() ? Vec3(0, 0, 0) : Vec3(box.center());
  page.left = margin + room / 2 - page.scale * middle[0];
  page.top = title_room + (drawing.height - title_room) / 2 + page.scale * middle[1];

  std::vector<Item> items;
  const int m = std::clamp(static_cast<int>(std::sqrt(most_patches / std::max<double>(1, quads.size()))), 1, 6);
  for (const Quad& quad : quads) {
    Item item{mean_depth(quad.corners), {}};
    const double s = shade(normal_of(quad.corners));
    const auto weights = [](double p, double q) { return std::array{(1 - p) * (1 - q), p * (1 - q), p * q, (1 - p) * q}; };
    const auto at = [&](double p, double q) {
      const auto N = weights(p, q);
      Vec3 x = Vec3::Zero();
      for (int k = 0; k < 4; ++k) x += N[k] * quad.corners[k];
      return page(x);
    };
    const auto colour_at = [&](double p, double q) {
      if (!coloured) return shaded(paper, s);
      const auto N = weights(p, q);
      double value = 0;
      for (int k = 0; k < 4; ++k) value += N[k] * scene.values[quad.nodes[k]];
      return shaded(scale_colour((value - low) / (high - low)), s);
    };
    // below the parts of a quad the quad itself, so that the page does not shine through between them
    item.marks.push_back(Patch{{at(0, 0), at(1, 0), at(1, 1), at(0, 1)}, colour_at(0.5, 0.5)});
    for (int i = 0; i < m && m > 1 && coloured; ++i)
      for (int j = 0; j < m; ++j) {
        const double p0 = double(i) / m, p1 = double(i + 1) / m, q0 = double(j) / m, q1 = double(j + 1) / m;
        item.marks.push_back(Patch{{at(p0, q0), at(p1, q0), at(p1, q1), at(p0, q1)}, colour_at((p0 + p1) / 2, (q0 + q1) / 2)});
      }
    item.marks.push_back(Stroke{{at(0, 0), at(1, 0), at(1, 1), at(0, 1), at(0, 0)}, ink, 0.7, 0.8});
    items.push_back(std::move(item));
  }
  for (const auto& patch : ball) {
    const Vec3 n = normal_of(patch);
    if (n[2] <= 0) continue;
    std::vector<PagePoint> corners;
    for (const Vec3& corner : patch) corners.push_back(page(corner));
    Item item{mean_depth(patch), {Patch{corners, shaded(steel, 0.35 + 0.65 * light(n)), 0.5}}};
    if (corners.size() > 4) {  // the disc where the sphere is cut
      corners.push_back(corners.front());
      item.marks = {Patch{corners, Colour{0.88, 0.89, 0.91}}, Stroke{corners, ink, 0.8}};
    }
    items.push_back(std::move(item));
  }
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) { return a.depth < b.depth; });
  for (Item& item : items) std::move(item.marks.begin(), item.marks.end(), std::back_inserter(drawing.marks));
  for (const auto& edge : outline)
    drawing.marks.push_back(Stroke{{page(R * mesh.X[edge[0]]), page(R * mesh.X[edge[1]])}, grey, 1.3});
  add_actions(drawing, scene, R, page, extent);
  add_points(drawing, scene, R, page);
  if (coloured) add_colour_bar(drawing, title_room, low, high, scene.label);
  add_axes(drawing, R);
  if (!choice.title.empty()) drawing.marks.push_back(Label{{page_width / 2, margin + 12}, choice.title, 17, Label::Anchor::middle});
  return drawing;
}

}  // namespace langer
