// The contact law of one candidate, differentiated in its accepted state:  x x' + r r' = h
//   open       r' = 0
//   closed     gap' = 0; without friction the tangential reaction stays 0
//   sticking   slip' = 0
//   slipping   r_t = -mu r_n s differentiated; s: direction of the slip
#pragma once

#include "core/tensor/types.hpp"
#include "mechanics/contact/local_problem.hpp"

namespace langer {

struct LawRows {
  Mat3 x = Mat3::Zero(), r = Mat3::Zero();
};

// What a candidate does: local reaction, length of its slip [mm].
struct CandidateState {
  ContactStatus status = ContactStatus::open;
  double mu = 0;
  Vec3 r = Vec3::Zero();
  double slip = 0;
};

// Each row has the size of a compliance; typical: such a one [mm/N].
LawRows law_rows(const CandidateState& state, double typical);

}  // namespace langer
