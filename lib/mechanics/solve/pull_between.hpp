// How much of the greatest pull of an adhesive indenter lies between the ends of increments.
#pragma once

namespace langer {

class Increment;

// From a parabola through the forces at the last two accepted states and at the trial, along the
// way of the indenter in this increment: by how much the top of the pull may exceed what the ends
// of this increment and of the next one show, over the pull. 0 where no top is near, and for
// indenters under force control, whose pull is prescribed.
double pull_between(const Increment& increment);

}  // namespace langer
