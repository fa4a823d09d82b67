// Every indenter: the normal is the gradient of the gap, the curvature is the gradient of the normal, the gap is a distance.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "contact/rigid.hpp"
#include "support/indentation.hpp"
#include "support/laws.hpp"

using namespace langer;

namespace {

// lower half of a sphere as triangles, normals outwards; rings from the pole (0, -R, 0) to the equator
Triangles half_sphere(double R, int rings, int sectors) {
  Triangles t;
  t.points.emplace_back(0, -R, 0);
  for (int i = 1; i <= rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double a = 0.5 * M_PI * i / rings, b = 2 * M_PI * j / sectors;
      t.points.emplace_back(R * std::sin(a) * std::cos(b), -R * std::cos(a), R * std::sin(a) * std::sin(b));
    }
  const auto id = [&](int i, int j) { return i == 0 ? 0 : 1 + (i - 1) * sectors + (j % sectors); };
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
          {"facets", facets}};
}

}  // namespace

TEST_CASE("normal and curvature are the first and second derivatives of the gap") {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> u(-6, 6);
  for (const auto& [name, shape] : shapes()) {
    CAPTURE(name);
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
        const ShapePoint a = shape_at(shape, x + h * Vec3::Unit(j)), b = shape_at(shape, x - h * Vec3::Unit(j));
        gradient[j] = (a.gap - b.gap) / (2 * h), slope.col(j) = (a.normal - b.normal) / (2 * h);
        smooth = smooth && (a.curvature - p.curvature).norm() < 1e-3 && (b.curvature - p.curvature).norm() < 1e-3;
      }
      CHECK(p.normal.norm() == doctest::Approx(1).epsilon(1e-12));
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
  const Indenter ball = Ellipsoid{{2, 2, 2}, {0, 1, 0}}, sphere = Sphere{2, {0, 1, 0}}, egg = Ellipsoid{{3, 1.5, 2}, {0, 5, 0}};
  for (const Vec3& x : {Vec3(3, 0, 1), Vec3(0.3, -1.2, 0.4), Vec3(0, -3, 0)}) {
    CHECK(shape_at(ball, x).gap == doctest::Approx(shape_at(sphere, x).gap).epsilon(1e-10));
    CHECK((shape_at(ball, x).curvature - shape_at(sphere, x).curvature).norm() < 1e-8);
  }
  CHECK(shape_at(egg, Vec3(0, 3, 0)).gap == doctest::Approx(0.5).epsilon(1e-10));
  CHECK(shape_at(egg, Vec3(4, 5, 0)).gap == doctest::Approx(1).epsilon(1e-10));
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

TEST_CASE("every indenter presses: exact law, few iterations, a finely faceted sphere gives the sphere's force") {
  test::Indentation scene;
  scene.nx = scene.nz = 14, scene.ny = 4, scene.h = 0.45, scene.depth = 0.5, scene.reach = 3;
  const auto press = [&](const std::string& name, const Indenter& shape) {
    scene.shape = shape;
    const auto result = scene.run(test::table1(60, 1e-6));
    CAPTURE(name);
    CHECK(result.path.complete);
    CHECK(result.path.cuts == 0);
    for (const auto& step : result.steps) {
      CHECK(step.defect.penetration <= 1e-9);
      CHECK(step.defect.cone <= 1e-8);
      CHECK(step.defect.complementarity <= 1e-8);
    }
    MESSAGE(name << ": " << result.steps.back().force << " N, " << result.path.iterations << " iterations");
    return result.steps.back().force;
  };
  const double ball = press("sphere", Sphere{2.5, {0, 6.5, 0}});
  CHECK(press("ellipsoid of equal axes", Ellipsoid{{2.5, 2.5, 2.5}, {0, 6.5, 0}}) == doctest::Approx(ball).epsilon(1e-8));
  CHECK(press("flat-ended cylinder", Cylinder{2, 0.4, {0, 4, 0}, {0, 1, 0}}) > 1.5 * ball);
  CHECK(press("long ellipsoid", Ellipsoid{{5, 2.5, 2.5}, {0, 6.5, 0}}) > ball);
  Facets facets;
  facets.rounding = 0.5, facets.move = {0, 6.5, 0};
  Triangles t = half_sphere(2, 24, 48);
  for (Vec3& p : t.points) p += vec(facets.move);
  facets.tree = std::make_shared<TriangleTree>(std::move(t));
  CHECK(press("faceted sphere", facets) == doctest::Approx(ball).epsilon(0.01));
}
