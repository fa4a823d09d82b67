// Measured files of scenes: units of columns, and ends of columns of different length.
#include "identification/inverse/scene_data.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

using namespace langer;

namespace {

const std::string folder = BINARY_DIR "/tests/scene_data";

SceneData read(const std::string& text, const FitColumns& columns) {
  std::filesystem::create_directories(folder);
  const std::string file = folder + "/scene.csv";
  std::ofstream(file, std::ios::binary) << text;
  FitData data;
  data.kind = DataKind::scene;
  data.columns = columns;
  return read_scene_data(data, file);
}

std::string refusal(const std::string& text, const FitColumns& columns) {
  try {
    read(text, columns);
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::input);
    return failure.what();
  }
  return "accepted";
}

bool holds(const std::string& text, const std::string& part) {
  CAPTURE(text);
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("columns of a scene are converted by the unit in their names, as those of a test") {
  struct Unit {
    std::string time, force;
    double seconds, newtons;  // of 2
  };
  for (const Unit& unit :
       {Unit{"Time (min)", "Force (gf)", 120, 2 * 9.80665e-3},
        Unit{"t_h", "Load, lbf", 7200, 2 * 4.4482216152605}, Unit{"Minutes", "F/kN", 120, 2000},
        Unit{"t_ms", "force_mN", 2e-3, 2e-3}, Unit{"Zeit", "Kraft [kgf]", 2, 2 * 9.80665}}) {
    CAPTURE(unit.time);
    FitColumns columns;
    columns.time = unit.time;
    columns.force = unit.force;
    const SceneData data = read(unit.time + ";" + unit.force + "\n0;0\n2;2\n", columns);
    CHECK(std::abs(data.find("time")->values[1] - unit.seconds) < 1e-9 * unit.seconds);
    CHECK(std::abs(data.find("force")->values[1] - unit.newtons) < 1e-9 * unit.newtons);
  }
  FitColumns columns;
  columns.time = "Time (mm)";
  columns.force = "force_N";
  CHECK(
      holds(refusal("Time (mm),force_N\n0,0\n1,2\n", columns),
            "columns.time: the unit mm of the column \"Time (mm)\"; expected one of time: s, ms"));
  // an index that looks like a unit
  columns = {};
  columns.u_ind = "u_h";
  columns.force = "force_N";
  CHECK(read("u_h,force_N\n0,0\n1,2\n", columns).find("u_ind")->values[1] == 1);
}

TEST_CASE("cells without a value end the columns of a scene, and are refused between points") {
  FitColumns columns;
  columns.u_ind = "u_mm";
  columns.force = "force_N";
  const SceneData data =
      read("other,u_mm,force_N\n1,0,0\n2,1,2\n3,,\n4,#N/A,#N/A\n5,NaN,NaN\n", columns);
  CHECK(data.find("force")->values == std::vector<double>{0, 2});
  CHECK(data.rows.size() == 2);
  CHECK(holds(refusal("u_mm,force_N\n0,0\n#N/A,#N/A\n1,2\n", columns), "scene.csv:3:1"));
  CHECK(holds(refusal("u_mm,force_N\n0,0\n1,2\n2,\n", columns), "scene.csv:4:3"));
}
