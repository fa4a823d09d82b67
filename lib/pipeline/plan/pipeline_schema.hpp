// JSON Schema of a pipeline file, from the table of stages and their ports.
#pragma once

#include <string>

namespace langer::pipeline {

std::string pipeline_schema();

}  // namespace langer::pipeline
