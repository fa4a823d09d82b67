// A fitted material as input of other programs, ready to paste, in mm, N, MPa, or a note if a
// program lacks the model. Models are matched by their energy. Parameters are converted if a
// program defines them differently (Ogden in Abaqus: mu alpha/2). A volume term of another form is
// noted in the card; the bulk modulus is 2/d in any case.
#pragma once

#include <string>
#include <vector>

#include "mechanics/material/material.hpp"

namespace langer {

// The text for one program and the name of its file.
struct Card {
  std::string program, file, text;
  bool exists = false;  // false: the text is a note only
};

std::vector<Card> cards(const Material& material);  // Abaqus, ANSYS, FEBio, CalculiX

}  // namespace langer
