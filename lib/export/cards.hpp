// A fitted law as input of other programs, ready to paste, in mm, N, MPa, and a note where it does
// not exist there. Laws are matched energy by energy: parameters are converted where a program
// counts differently (Abaqus' Ogden: mu alpha/2), and a volume term of another form is told; its
// bulk modulus is 2/d in any case.
#pragma once

#include <string>
#include <vector>

#include "mechanics/material/material.hpp"

namespace langer {

struct Card {
  std::string program, file, text;
  bool exists = false;  // false: the text is a note only
};

std::vector<Card> cards(const Material& material);  // Abaqus, ANSYS, FEBio, CalculiX

}  // namespace langer
