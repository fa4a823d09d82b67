// Which candidates of contact an increment has to keep apart from the rest of the body.
//
// Rows of candidates are eliminated last, as one dense block: that block, and what it spoils in the
// ordering of the other rows, is most of the cost where a contact may happen on a large set. Few of
// its nodes are ever near the indenter. So only those rows are eliminated last that the indenter
// can reach in the increment; the others are rows like any other.
//
// The candidates are sorted once by how close the indenter comes to their place at rest along its
// path. Level k holds the first ones of that order, half as many again as level k - 1; the last
// level holds all. An increment takes the lowest level that holds all candidates within reach. It
// follows from the state at its beginning alone, so that an interrupted path goes on with the same
// digits, and it does not depend on how many nodes the set has that are never near.
//
// What a level leaves out is not lost: every linear step looks at all candidates where they are
// (contact_linearisation.cpp), and takes a higher level where one might close. A candidate that a
// step brings inside the indenter violates the contact law, and another step follows.
#pragma once

#include <vector>

#include "mechanics/contact/contact.hpp"

namespace langer {

class CandidateLevels {
 public:
  CandidateLevels() = default;
  CandidateLevels(const std::vector<RigidContact>& contacts, const std::vector<Vec3>& X);

  // the lowest level that holds the candidate
  int of(std::size_t contact, std::size_t candidate) const { return level_[contact][candidate]; }
  int all() const { return all_; }       // the level that holds every candidate
  int holding(std::size_t first) const;  // the lowest level with that many candidates
  std::size_t size() const { return closest_.size(); }
  // candidates whose place at rest the path of the indenter comes this close to [mm]; all of an
  // indenter whose path is not known before it is pushed
  std::size_t on_the_path(double distance) const;

 private:
  std::vector<std::vector<int>> level_;
  std::vector<double> closest_;  // of each candidate [mm]
  int all_ = 0;
};

}  // namespace langer
