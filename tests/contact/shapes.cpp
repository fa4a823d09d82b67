// Every indenter: the normal is the gradient of the gap, the curvature is the gradient of the
// normal, the gap is a distance.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <set>

#include "mechanics/contact/rigid.hpp"
#include "mechanics/mesh/reference.hpp"
#include "support/indentation.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// lower half of a sphere as triangles, normals outwards; rings from the pole (0, -R, 0) to the
// equator
Triangles half_sphere(double R, int rings, int sectors) {
  Triangles t;
  t.points.emplace_back(0, -R, 0);
  for (int i = 1; i <= rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double a = 0.5 * M_PI * i / rings, b = 2 * M_PI * j / sectors;
      t.points.emplace_back(R * std::sin(a) * std::cos(b), -R * std::cos(a),
                            R * std::sin(a) * std::sin(b));
    }
  const auto id = [&](int i, int j) {
    return i == 0 ? 0 : 1 + (i - 1) * sectors + (j % sectors);
  };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      t.corners.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      if (i > 0) t.corners.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  return t;
}

std::vector<std::pair<const char*, Indenter>> shapes() {
  Facets facets;
  facets.rounding = 0.3;
  facets.tree = std::make_shared<TriangleTree>(half_sphere(2, 3, 7));
  return {{"sphere", Sphere{2.5, {0.1, 6, -0.2}}},
          {"plane", Plane{{0, 1, 0}, {0.2, 1, 0.3}}},
          {"cylinder", Cylinder{2, 0.5, {0, 4, 0}, {0.1, 1, 0.2}}},
          {"ellipsoid", Ellipsoid{{3, 1.5, 2}, {0, 5, 0.5}}},
          {"aperture", Aperture{2, 0.4, {0.1, 1, 0.2}, {0.1, 1, -0.2}}},
          {"facets", facets}};
}

// a closed surface of triangles: a box about 0
Facets faceted_box(const Vec3& half) {
  Triangles t;
  for (const auto& corner : Hex8::corner)
    t.points.push_back(half.cwiseProduct(Vec3(corner[0], corner[1], corner[2])));
  for (const auto& f : Hex8::facet)
    t.corners.push_back({f[0], f[1], f[2]}), t.corners.push_back({f[0], f[2], f[3]});
  Facets facets;
  facets.rounding = 0.25;
  facets.tree = std::make_shared<TriangleTree>(t);
  return facets;
}

Vec3 area_vector(const Outline& outline) {
  Vec3 sum = Vec3::Zero();
  for (const auto& face : outline.faces)
    for (std::size_t k = 2; k < face.size(); ++k)
      sum += 0.5 * (outline.points[face[k - 1]] - outline.points[face[0]])
                       .cross(outline.points[face[k]] - outline.points[face[0]]);
  return sum;
}

double area(const Outline& outline) {
  double sum = 0;
  for (const auto& face : outline.faces) {
    Outline one{outline.points, {face}, {}};
    sum += area_vector(one).norm();
  }
  return sum;
}

std::vector<std::pair<const char*, Indenter>> closed_shapes() {
  std::vector<std::pair<const char*, Indenter>> list;
  for (const auto& [name, shape] : shapes())
    if (point_inside(shape) && !std::holds_alternative<Facets>(shape))
      list.emplace_back(name, shape);
  list.emplace_back("faceted box", faceted_box({1, 0.6, 2}));
  return list;
}

}  // namespace

TEST_CASE("every indenter answers what its discretisation and its drawing need") {
  const Sphere sphere{2.5, {0.1, 6, -0.2}};
  CHECK(force_order(sphere) == 2);
  CHECK(edge_sharpness(sphere) == 1);
  REQUIRE(ball_of(sphere));
  CHECK(ball_of(sphere)->centre == Vec3(0.1, 6, -0.2));
  CHECK(ball_of(sphere)->radius == 2.5);
  CHECK(ball_of(sphere)->radius == -shape_at(sphere, ball_of(sphere)->centre).gap);

  // an edge or an edge of the body under a flat face: the force converges with h alone
  const Cylinder punch{2, 0.5, {0, 4, 0}, {0.1, 1, 0.2}};
  CHECK(force_order(punch) == 1);
  CHECK(edge_sharpness(punch) == 4);
  CHECK(edge_sharpness(Cylinder{2, 0, {}, {0, 1, 0}}) == 1);
  const Plane plane{{0, 1, 0}, {0.2, 1, 0.3}};
  CHECK(force_order(plane) == 1);
  CHECK(force_order(Ellipsoid{{3, 1.5, 2}, {0, 5, 0.5}}) == 2);

  // the hole's rim: the plate's face begins at radius + edge
  const Aperture plate{2, 0.4, {0.1, 1, 0.2}, {0, 1, 0}};
  CHECK(force_order(plate) == 1);
  REQUIRE(hole_of(plate));
  const RoundHole hole = *hole_of(plate);
  const Vec3 on_face = hole.axis.point + (hole.radius + hole.edge) * Vec3::UnitX();
  CHECK(std::abs(shape_at(plate, on_face).gap) < 1e-12);
  CHECK(shape_at(plate, hole.axis.point + hole.edge * hole.axis.along).gap ==
        near(hole.radius, 1e-14));

  for (const auto& named : shapes()) {
    const auto& name = named.first;
    const auto& shape = named.second;
    CAPTURE(name);
    CHECK(is_flat(shape) == (std::string(name) == "plane"));
    CHECK(ball_of(shape).has_value() == (std::string(name) == "sphere"));
    CHECK(hole_of(shape).has_value() == (std::string(name) == "aperture"));
    CHECK(is_from_file(shape) == (std::string(name) == "facets"));
    CHECK((triangles_of(shape) != nullptr) == is_from_file(shape));
  }
}

TEST_CASE("triangles of a file are scaled, then moved; triangles in place stay") {
  Facets facets;
  facets.scale = 10;
  facets.move = {1, 2, 3};
  facets.file.path = "surface.stl";
  Indenter shape = facets;
  CHECK(surface_file(shape) == "surface.stl");
  const Triangles t = half_sphere(2, 3, 7);
  set_file_triangles(shape, t);
  REQUIRE(triangles_of(shape));
  for (std::size_t i = 0; i < t.points.size(); ++i)
    CHECK((triangles_of(shape)->points[i] - (10 * t.points[i] + Vec3(1, 2, 3))).norm() < 1e-12);
  set_triangles(shape, t);
  for (std::size_t i = 0; i < t.points.size(); ++i)
    CHECK(triangles_of(shape)->points[i] == t.points[i]);
  CHECK(triangles_of(shape)->corners == t.corners);
}

TEST_CASE("every kind of indenter is among those that are tested here") {
  std::set<std::size_t> kinds;
  for (const auto& [name, shape] : shapes()) {
    kinds.insert(shape.index());
    CHECK(std::string(name) == std::visit([](const auto& s) { return std::string(s.key); }, shape));
  }
  CHECK(kinds.size() == std::variant_size_v<Indenter>);
}

TEST_CASE("a shape is unchanged by an operation where its gap is, and says so") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-6, 6);
  const Vec3 o = Vec3::Zero();
  std::vector<Indenter> list{Sphere{2, {0, 3, 0}},
                             Plane{{0, 1, 0}, {0, 1, 0}},
                             Plane{{0, 1, 0}, {0, 1, 0.2}},
                             Cylinder{2, 0.5, {0, 4, 0}},
                             Ellipsoid{{2, 1, 2}, {0, 3, 0}},
                             Ellipsoid{{2, 1, 1.5}, {0, 3, 0}}};
  for (const auto& [name, shape] : shapes()) list.push_back(shape);
  std::vector<Isometry> operations;
  for (const Vec3& centre : {o, Vec3(0.1, 0, -0.2), Vec3(0, 5, 0.5)}) {
    for (const Vec3& signs : {Vec3(-1, 1, 1), Vec3(1, 1, -1), Vec3(-1, 1, -1), Vec3(1, -1, 1)})
      operations.push_back({signs.asDiagonal(), centre});
    for (double angle : {1.0, M_PI / 2, 0.3})
      operations.push_back({Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix(), centre});
    operations.push_back(
        {Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix(), centre});
  }
  int unchanged = 0, changed = 0;
  for (const Indenter& shape : list)
    for (const Isometry& op : operations) {
      double largest = 0;
      for (int k = 0; k < 60; ++k) {
        const Vec3 x(u(random), u(random), u(random));
        largest = std::max(largest, std::abs(shape_at(shape, op(x)).gap - shape_at(shape, x).gap));
      }
      const bool says = unchanged_by(shape, op);
      CAPTURE(shape.index());
      if (says) CHECK(largest < 1e-8);
      if (!says && !std::holds_alternative<Facets>(shape)) CHECK(largest > 1e-3);
      ++(says ? unchanged : changed);
    }
  CHECK(unchanged > 20);
  CHECK(changed > 100);
}

TEST_CASE("a shape becomes another by a mirror or a turn exactly where the other is its image") {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> u(-6, 6), part(0.5, 2);
  const Isometry mirror{Vec3(-1, 1, 1).asDiagonal(), {0.5, 0, -1}},
      turn{Vec3(-1, 1, -1).asDiagonal(), {0.5, 0, -1}};
  int images = 0, others = 0;
  for (int n = 0; n < 200; ++n) {
    const Isometry& op = n % 2 ? mirror : turn;
    const Vec3 at(u(random), u(random), u(random)), to = op(at);
    const auto place = [](const Vec3& x) {
      return std::array{x[0], x[1], x[2]};
    };
    const double r = part(random), q = part(random);
    const Vec3 axis(u(random), u(random), u(random)), turned = op.turn * axis;
    Indenter a, b;
    switch (n % 4) {
      case 0:
        a = Sphere{r, place(at)}, b = Sphere{r, place(to)};
        break;
      case 1:
        a = Plane{place(at), place(axis)}, b = Plane{place(to), place(2 * turned)};
        break;
      case 2:
        a = Cylinder{r, 0.3 * r, place(at), place(axis)},
        b = Cylinder{r, 0.3 * r, place(to), place(3 * turned)};
        break;
      case 3:
        a = Ellipsoid{{r, q, 1}, place(at)}, b = Ellipsoid{{r, q, 1}, place(to)};
        break;
    }
    const bool spoiled = n % 8 > 3;
    if (spoiled)
      std::visit(
          []<class S>(S& s) {
            if constexpr (requires { s.radius; }) s.radius *= 1.1;
            if constexpr (requires { s.half_axes; }) s.half_axes[1] *= 1.1;
            if constexpr (requires { s.outward; }) s.outward[0] += 0.5;
          },
          b);
    CAPTURE(n);
    CHECK(maps_onto(a, b, op) == !spoiled);
    CHECK(maps_onto(b, a, op) == !spoiled);
    CHECK_FALSE(maps_onto(a, Sphere{0.1, {50, 0, 0}}, op));
    double largest = 0;
    for (int k = 0; k < 40; ++k) {
      const Vec3 x(u(random), u(random), u(random));
      largest = std::max(largest, std::abs(shape_at(b, op(x)).gap - shape_at(a, x).gap));
    }
    if (!spoiled) CHECK(largest < 1e-8);
    ++(spoiled ? others : images);
  }
  CHECK(images == 100);
  CHECK(others == 100);
}

TEST_CASE("the outline of every shape lies on its surface and is seen from outside") {
  auto list = shapes();
  list.emplace_back("box", faceted_box({1, 0.6, 2}));
  for (const auto& [name, shape] : list) {
    const auto named = name;
    CAPTURE(named);
    const Outline out = outline(shape, {Vec3(0, 2, 0), 10, 24});
    CHECK(out.faces.size() > 20);
    double farthest = 0;
    for (const Vec3& x : out.points)
      farthest = std::max(farthest, std::abs(shape_at(shape, x).gap));
    CHECK(farthest < 1e-9);
    int inwards = 0, large = 0;
    for (const auto& face : out.faces) {
      const Outline one{out.points, {face}, {}};
      Vec3 middle = Vec3::Zero();
      for (int p : face) middle += out.points[p] / static_cast<double>(face.size());
      const Vec3 n = area_vector(one);
      if (n.norm() < 1e-9) continue;   // a strip between triangles of one plane
      if (face.size() > 24) continue;  // the end of what goes on
      ++large, inwards += n.dot(shape_at(shape, middle + 1e-3 * n.normalized()).normal) < 0;
    }
    CHECK(large > 5);
    CHECK(inwards == 0);
    CHECK(std::isfinite(half_width(shape)) == point_inside(shape).has_value());
    if (const auto p = point_inside(shape)) CHECK(shape_at(shape, *p).gap < 0);
  }
  const Outline ball = outline(Sphere{2, {1, 2, 3}}, {Vec3::Zero(), 1, 96});
  CHECK(area(ball) == near(4 * M_PI * 4, 1e-3));
}

TEST_CASE("the length of a normal or an axis does not matter, whatever it is") {
  const auto with = [](double length) {
    return std::array<Indenter, 2>{
        Plane{{0, 1, 0}, {0.2 * length, length, 0.3 * length}},
        Cylinder{2, 0.5, {0, 4, 0}, {0.1 * length, length, 0.2 * length}}};
  };
  const Vec3 x(0.3, 3.6, 1.1);
  for (double length : {1e-200, 1e-150, 1e3, 1e200})
    for (std::size_t i = 0; i < 2; ++i) {
      const Indenter one = with(1)[i], other = with(length)[i];
      CHECK(std::visit(
          [](const auto& shape) {
            if constexpr (requires { shape.complaints(); }) return shape.complaints().empty();
            return true;
          },
          other));
      CHECK(shape_at(other, x).gap == near(shape_at(one, x).gap, 1e-14));
      CHECK((shape_at(other, x).normal - shape_at(one, x).normal).norm() < 1e-14);
    }
}

TEST_CASE(
    "a plate with a hole has no end: a plane through it leaves the two lines of its profile, and no face") {
  const Outline whole = outline(Aperture{2, 0.25, {0, 4, 0}, {0, 1, 0}}, {Vec3::Zero(), 10, 24});
  for (double at : {0., 0.1}) {
    const OpenedOutline cut = cut_open(whole, 2, at, -1);
    CHECK(!cut.kept.faces.empty());
    CHECK(cut.cap.faces.empty());
    REQUIRE(cut.kept.lines.size() == whole.lines.size() + 2);
    for (const auto& line : cut.kept.lines)
      for (int p : line) CHECK(cut.kept.points[static_cast<std::size_t>(p)][2] == near(at));
  }
}

TEST_CASE("outlines are closed, and what is cut off them leaves a face in the plane") {
  for (const auto& [name, shape] : closed_shapes()) {
    const auto named = name;
    CAPTURE(named);
    const Outline whole = outline(shape, {Vec3::Zero(), 10, 24});
    CHECK(area_vector(whole).norm() < 1e-9 * area(whole));
    for (int axis = 0; axis < 3; ++axis) {
      double low = 1e300, high = -1e300;
      for (const Vec3& x : whole.points)
        low = std::min(low, x[axis]), high = std::max(high, x[axis]);
      const double at = low + 0.37 * (high - low);
      for (double side : {-1., 1.}) {
        const OpenedOutline cut = cut_open(whole, axis, at, side);
        for (const Vec3& x : cut.kept.points) CHECK(side * (x[axis] - at) > -1e-12);
        for (const Vec3& x : cut.cap.points) CHECK(x[axis] == at);
        REQUIRE(!cut.cap.faces.empty());
        CHECK((area_vector(cut.kept) + area_vector(cut.cap)).norm() < 1e-9 * area(whole));
        CHECK(side * area_vector(cut.cap)[axis] < 0);
      }
      CHECK(cut_open(whole, axis, high + 1, 1).kept.faces.empty());
      CHECK(cut_open(whole, axis, high + 1, -1).kept.faces.size() == whole.faces.size());
    }
  }
}

TEST_CASE("normal and curvature are the first and second derivatives of the gap") {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> u(-6, 6);
  for (const auto& [name, shape] : shapes()) {
    const auto named = name;
    CAPTURE(named);
    int checked = 0;
    for (int k = 0; k < 400; ++k) {
      const Vec3 x(u(random), u(random), u(random));
      const ShapePoint p = shape_at(shape, x);
      if (p.gap < 0.05) continue;  // outside, where contact looks
      const double h = 1e-5;
      Mat3 slope;
      Vec3 gradient;
      bool smooth = true;  // no border between pieces of the shape within reach of the difference
      for (int j = 0; j < 3; ++j) {
        const ShapePoint a = shape_at(shape, x + h * Vec3::Unit(j)),
                         b = shape_at(shape, x - h * Vec3::Unit(j));
        gradient[j] = (a.gap - b.gap) / (2 * h), slope.col(j) = (a.normal - b.normal) / (2 * h);
        smooth = smooth && (a.curvature - p.curvature).norm() < 1e-3 &&
                 (b.curvature - p.curvature).norm() < 1e-3;
      }
      CHECK(p.normal.norm() == near(1, 1e-12));
      CHECK((gradient - p.normal).norm() < 1e-8);
      if (!smooth) continue;
      CHECK((slope - p.curvature).norm() < 1e-5);
      CHECK((p.curvature * p.normal).norm() < 1e-10);
      ++checked;
    }
    CHECK(checked > 100);
  }
}

TEST_CASE("an ellipsoid of equal axes is a sphere, its poles are where they should be") {
  const Indenter ball = Ellipsoid{{2, 2, 2}, {0, 1, 0}}, sphere = Sphere{2, {0, 1, 0}},
                 egg = Ellipsoid{{3, 1.5, 2}, {0, 5, 0}};
  for (const Vec3& x : {Vec3(3, 0, 1), Vec3(0.3, -1.2, 0.4), Vec3(0, -3, 0)}) {
    CHECK(shape_at(ball, x).gap == near(shape_at(sphere, x).gap, 1e-10));
    CHECK((shape_at(ball, x).curvature - shape_at(sphere, x).curvature).norm() < 1e-8);
  }
  CHECK(shape_at(egg, Vec3(0, 3, 0)).gap == near(0.5, 1e-10));
  CHECK(shape_at(egg, Vec3(4, 5, 0)).gap == near(1, 1e-10));
  CHECK((shape_at(egg, Vec3(0, 3, 0)).normal - Vec3(0, -1, 0)).norm() < 1e-10);
}

TEST_CASE("facets know inside from outside and find the nearest triangle") {
  const Triangles t = half_sphere(2, 6, 12);
  const TriangleTree tree(t);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-3, 3);
  for (int k = 0; k < 300; ++k) {
    const Vec3 x(u(random), -std::abs(u(random)), u(random));
    const auto near = tree.nearest(x);
    double brute = 1e300;  // vertices are never nearer than the nearest point
    for (const Vec3& p : t.points) brute = std::min(brute, (x - p).norm());
    CHECK((x - near.point).norm() <= brute + 1e-12);
    if (x.norm() > 2.01) CHECK(near.sign == 1);
    if (x.norm() < 1.8 && x[1] < -0.3) CHECK(near.sign == -1);
  }
}

TEST_CASE(
    "every indenter presses: exact law, few iterations, a finely faceted sphere gives the sphere's force") {
  test::Indentation scene;
  scene.nx = scene.nz = 14, scene.ny = 4, scene.h = 0.45, scene.depth = 0.5, scene.reach = 3;
  const auto press = [&](const std::string& name, const Indenter& shape) {
    scene.shape = shape;
    const auto result = scene.run(test::table1(60, 1e-6));
    CAPTURE(name);
    CHECK(result.path.complete);
    CHECK(result.path.cut_backs == 0);
    for (const auto& step : result.steps) {
      CHECK(step.defect.penetration <= 1e-9);
      CHECK(step.defect.cone <= 1e-8);
      CHECK(step.defect.complementarity <= 1e-8);
    }
    MESSAGE(name << ": " << result.steps.back().force << " N, " << result.path.iterations
                 << " iterations");
    return result.steps.back().force;
  };
  const double ball = press("sphere", Sphere{2.5, {0, 6.5, 0}});
  CHECK(press("ellipsoid of equal axes", Ellipsoid{{2.5, 2.5, 2.5}, {0, 6.5, 0}}) ==
        near(ball, 1e-8));
  CHECK(press("flat-ended cylinder", Cylinder{2, 0.4, {0, 4, 0}, {0, 1, 0}}) > 1.5 * ball);
  CHECK(press("long ellipsoid", Ellipsoid{{5, 2.5, 2.5}, {0, 6.5, 0}}) > ball);
  Facets facets;
  facets.rounding = 0.5, facets.move = {0, 6.5, 0};
  Triangles t = half_sphere(2, 24, 48);
  for (Vec3& p : t.points) p += vec(facets.move);
  facets.tree = std::make_shared<TriangleTree>(std::move(t));
  CHECK(press("faceted sphere", facets) == near(ball, 0.01));
}

TEST_CASE(
    "a surface of very many triangles is shown by a few thousand polygons, as large and seen from outside") {
  for (int rings : {20, 60, 250}) {
    CAPTURE(rings);
    Triangles whole = half_sphere(2, rings, 2 * rings);
    const auto points = whole.points;
    const auto corners = whole.corners;
    const int n = static_cast<int>(points.size()),
              below = n - 2 * rings;  // its rim belongs to both halves
    for (int i = 0; i < below; ++i)
      whole.points.emplace_back(points[i][0], -points[i][1], points[i][2]);
    const auto above = [&](int i) {
      return i < below ? n + i : i;
    };
    for (const auto& c : corners) whole.corners.push_back({above(c[0]), above(c[2]), above(c[1])});
    const std::size_t triangles = whole.corners.size();
    Facets facets;
    facets.rounding = 0.05;
    facets.tree = std::make_shared<TriangleTree>(std::move(whole));
    const Outline out = outline(facets, {Vec3::Zero(), 10, 24}),
                  ball = outline(Sphere{2, {0, 0, 0}}, {Vec3::Zero(), 10, 24});
    CHECK(out.faces.size() <= triangles);
    CHECK(out.faces.size() < 6 * ball.faces.size());
    CHECK(out.faces.size() > ball.faces.size() / 2);
    CHECK(area(out) == near(4 * M_PI * 2.05 * 2.05, 0.02));
    int inwards = 0;
    for (const auto& face : out.faces) {
      const Outline one{out.points, {face}, {}};
      inwards += area_vector(one).dot(out.points[face[0]]) < 0;
    }
    CHECK(inwards == 0);
    double farthest = 0;
    for (const Vec3& x : out.points)
      farthest = std::max(farthest, std::abs(shape_at(facets, x).gap));
    CHECK(farthest < 0.1 * facets.rounding);
  }
}

TEST_CASE("an aperture is the image of another only with the same hole, edge, face and axis") {
  const Isometry mirror{Vec3(-1, 1, 1).asDiagonal(), Vec3::Zero()};
  const Aperture left{2, 0.5, {-1, 4, 0.5}, {0.2, 1, 0.1}};
  const Aperture right{2, 0.5, {1, 4, 0.5}, {-0.2, 1, 0.1}};
  CHECK(maps_onto(left, right, mirror));
  CHECK(maps_onto(right, left, mirror));
  CHECK_FALSE(maps_onto(left, left, mirror));

  Aperture other = right;
  other.radius = 2.1;
  CHECK_FALSE(maps_onto(left, other, mirror));
  other = right;
  other.edge = 0.6;
  CHECK_FALSE(maps_onto(left, other, mirror));
  other = right;
  other.face[2] = 0.6;
  CHECK_FALSE(maps_onto(left, other, mirror));
  other = right;
  other.into = {0.2, 1, 0.1};
  CHECK_FALSE(maps_onto(left, other, mirror));
}

TEST_CASE("on the axis of a hole the wall is as far as its radius, whichever way the axis points") {
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.6, 0, 0.8)}) {
    const Indenter plate = Aperture{2, 0.5, {0.1, 4, 0.3}, {axis[0], axis[1], axis[2]}};
    CAPTURE(axis.transpose());
    // deeper than the rounded edge
    const ShapePoint p = shape_at(plate, Vec3(0.1, 4, 0.3) + 3 * axis);
    CHECK(p.gap == near(2));
    CHECK(p.normal.norm() == near(1));
    CHECK(std::abs(p.normal.dot(axis)) <= 1e-14);
  }
}

TEST_CASE("an ellipsoid has an axis where its two other half axes are equal") {
  const auto along = [](const std::array<double, 3>& half_axes) {
    const auto axis = axis_of(Ellipsoid{half_axes, {1, 2, 3}});
    if (axis) CHECK((axis->point - Vec3(1, 2, 3)).norm() == 0);
    return axis ? axis->along : Vec3(Vec3::Zero());
  };
  CHECK(along({2, 1, 2}) == Vec3::UnitY());
  CHECK(along({1, 2, 2}) == Vec3::UnitX());
  CHECK(along({2, 2, 1}) == Vec3::UnitZ());
  CHECK(along({1, 2, 3}) == Vec3::Zero());
}
