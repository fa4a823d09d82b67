#include "element/packet_solid.hpp"

#include <limits>

namespace langer {

namespace {

using P = Packet;

void displacement_gradient(const P* dN, const P* u, P* H) {
  for (int a = 0; a < 8; ++a)
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) H[3 * i + k] += u[3 * a + i] * dN[3 * a + k];
}

// J - 1 = tr H + i2(H) + det H
P dilatation(const P* H) {
  const P c0 = H[4] * H[8] - H[5] * H[7], c1 = H[5] * H[6] - H[3] * H[8], c2 = H[3] * H[7] - H[4] * H[6];
  const P i2 = H[0] * H[4] - H[1] * H[3] + c0 + H[8] * H[0] - H[6] * H[2];
  return (H[0] + H[4] + H[8]) + i2 + (H[0] * c0 + H[1] * c1 + H[2] * c2);
}

// What the law gives at one Gauss point, in the deformed state; components in the order of voigt.hpp.
struct Spatial {
  P tau[6];     // isochoric Kirchhoff stress
  P tau_trace;  // trace of sum 2 W' h, before the deviator is taken
  P W;
  int n = 0;  // terms of the tangent  4 W'' dev h x dev h
  P h[1 + 4][6];
  P stiffness[1 + 4];
};

constexpr int most_families = 4;

//   tau = dev sum 2 W' h,   h = I_bar-gradient pushed forward: b_bar for I1_bar,
//   kappa b_bar + (1 - 3 kappa) m (F a)(F a)^T for a fibre family
void law(const Material& material, const P* F, const P& J, const PacketFibre* fibres, Spatial& out) {
  const P root = cbrt(J), m = 1.0 / (root * root);  // I3^(-1/3)
  P b[6];
  for (int p = 0; p < 6; ++p) {
    const int i = voigt_i[p], j = voigt_j[p];
    b[p] = m * (F[3 * i] * F[3 * j] + F[3 * i + 1] * F[3 * j + 1] + F[3 * i + 2] * F[3 * j + 2]);
  }
  const P I1_bar = b[0] + b[1] + b[2];
  P dW, ddW;
  for (const MatrixTerm& term : material.matrix)
    std::visit(
        [&](const auto& t) {
          if constexpr (t.of == Invariant::I1_bar) {
            const Energy<P> e = t(I1_bar);
            out.W += e.W, dW += e.dW, ddW += e.ddW;
          }
        },
        term);
  const auto deviator = [](const P* h, P* d) {
    const P mean = (h[0] + h[1] + h[2]) * (1.0 / 3);
    for (int p = 0; p < 6; ++p) d[p] = p < 3 ? h[p] - mean : h[p];
  };
  P sum[6];
  for (int p = 0; p < 6; ++p) sum[p] = 2.0 * dW * b[p];
  out.stiffness[0] = 4.0 * ddW;
  deviator(b, out.h[0]);
  out.n = 1;
  for (std::size_t k = 0; k < material.fibres.size(); ++k) {
    const Fibre& fibre = material.fibres[k];
    P a[3], h[6];
    for (int i = 0; i < 3; ++i)
      a[i] = F[3 * i] * fibres[k].a[0] + F[3 * i + 1] * fibres[k].a[1] + F[3 * i + 2] * fibres[k].a[2];
    const double along = 1 - 3 * fibre.kappa;
    for (int p = 0; p < 6; ++p) h[p] = fibre.kappa * b[p] + along * m * a[voigt_i[p]] * a[voigt_j[p]];
    const P I4_bar = h[0] + h[1] + h[2], I4 = I4_bar / m;
    const Energy<P> e = fibre.hgo(I4_bar);
    // the same threshold as the scalar law
    const P from = 1 - 16 * std::numeric_limits<double>::epsilon();
    const P test =
        fibre.tension_switch == FibreSwitch::off ? P(1.0) : (fibre.tension_switch == FibreSwitch::I4 ? I4 : I4_bar) - from;
    const P dW4 = where_not_negative(test, e.dW);
    out.W += where_not_negative(test, e.W);
    for (int p = 0; p < 6; ++p) sum[p] += 2.0 * dW4 * h[p];
    out.stiffness[out.n] = 4.0 * where_not_negative(test, e.ddW);
    deviator(h, out.h[out.n++]);
  }
  out.tau_trace = sum[0] + sum[1] + sum[2];
  deviator(sum, out.tau);
}

// c = sum 4 W'' dev h x dev h + 2/3 tr (I - 1/3 1 x 1) - 2/3 (tau x 1 + 1 x tau) + p J (1 x 1 - 2 I) + bulk 1 x 1,  times w
void tangent(const Spatial& s, const P& pJ, const P& bulk, const P& w, P* c) {
  const P al = (2.0 / 3) * s.tau_trace, same = w * (al - 2.0 * pJ), ones = w * (pJ + bulk - al * (1.0 / 3));
  for (int p = 0; p < 6; ++p)
    for (int q = p; q < 6; ++q) {
      P x = p < 3 && q < 3 ? ones : P();
      if (p == q) x += p < 3 ? same : 0.5 * same;
      if (p < 3) x -= (2.0 / 3) * w * s.tau[q];
      if (q < 3) x -= (2.0 / 3) * w * s.tau[p];
      c[6 * p + q] = x;
    }
  for (int k = 0; k < s.n; ++k)
    for (int p = 0; p < 6; ++p) {
      const P wh = w * s.stiffness[k] * s.h[k][p];
      for (int q = p; q < 6; ++q) c[6 * p + q] += wh * s.h[k][q];
    }
  for (int p = 0; p < 6; ++p)
    for (int q = 0; q < p; ++q) c[6 * p + q] = c[6 * q + p];
}

// K_ab for b <= a:  B_a^T (c B_b) + (g_a . s g_b) I, with s the full Kirchhoff stress times w
void add_stiffness(const P (*g)[3], const P* c, const P* s, P* K) {
  for (int b = 0; b < 8; ++b) {
    const P* gb = g[b];
    P cB[3][6];  // columns of c B_b
    for (int p = 0; p < 6; ++p) {
      const P* r = c + 6 * p;
      cB[0][p] = r[0] * gb[0] + r[3] * gb[1] + r[5] * gb[2];
      cB[1][p] = r[1] * gb[1] + r[3] * gb[0] + r[4] * gb[2];
      cB[2][p] = r[2] * gb[2] + r[4] * gb[1] + r[5] * gb[0];
    }
    const P sg[3] = {s[0] * gb[0] + s[3] * gb[1] + s[5] * gb[2], s[3] * gb[0] + s[1] * gb[1] + s[4] * gb[2],
                     s[5] * gb[0] + s[4] * gb[1] + s[2] * gb[2]};
    for (int a = b; a < 8; ++a) {
      const P* ga = g[a];
      const P geometric = ga[0] * sg[0] + ga[1] * sg[1] + ga[2] * sg[2];
      for (int j = 0; j < 3; ++j) {
        const P* z = cB[j];
        const P column[3] = {z[0] * ga[0] + z[3] * ga[1] + z[5] * ga[2], z[1] * ga[1] + z[3] * ga[0] + z[4] * ga[2],
                             z[2] * ga[2] + z[4] * ga[1] + z[5] * ga[0]};
        for (int i = a == b ? j : 0; i < 3; ++i) {
          const int row = 3 * a + i;
          P& entry = K[row * (row + 1) / 2 + 3 * b + j];
          entry += column[i];
          if (i == j) entry += geometric;
        }
      }
    }
  }
}

}  // namespace

bool packet_form(const Material& material) {
  if (material.fibres.size() > most_families) return false;
  for (const MatrixTerm& term : material.matrix)
    if (!std::visit([](const auto& t) { return t.of == Invariant::I1_bar; }, term)) return false;
  return true;
}

PacketGeometry packed(const ElementGeometry* const geometry[P::lanes]) {
  PacketGeometry out;
  for (int l = 0; l < P::lanes; ++l) {
    for (int g = 0; g < 8; ++g) {
      for (int a = 0; a < 8; ++a)
        for (int k = 0; k < 3; ++k) out.dN_dX[g][3 * a + k].set(l, geometry[l]->dN_dX[g](a, k));
      out.w[g].set(l, geometry[l]->w[g]);
    }
    out.V.set(l, geometry[l]->V);
  }
  return out;
}

void packet_dilatations(const PacketGeometry& geometry, const Packet* u, Packet* J_minus_1) {
  for (int q = 0; q < 8; ++q) {
    P H[9];
    displacement_gradient(geometry.dN_dX[q], u, H);
    J_minus_1[q] = dilatation(H);
  }
}

void packet_solid(Formulation formulation, const Material& material, const PacketGeometry& geometry, const PacketFibre* fibres,
                  const Packet* u, const Packet* p_tangent, bool with_tangent, PacketElement& out) {
  const double kappa = material.volume.quadratic.bulk_modulus();
  const bool mean = formulation == Formulation::mean_dilatation;
  P F[8][9], g[8][8][3], J_minus_1[8];
  out.W = P(), out.J_min = P(1e300);
  P theta, b[24];
  for (int q = 0; q < 8; ++q) {
    const P* dN = geometry.dN_dX[q];
    P H[9];
    displacement_gradient(dN, u, H);
    J_minus_1[q] = dilatation(H);
    const P J = 1.0 + J_minus_1[q];
    out.J_min = P(J.v < out.J_min.v ? J.v : out.J_min.v);
    for (int i = 0; i < 9; ++i) F[q][i] = i % 4 == 0 ? 1.0 + H[i] : H[i];
    const P* f = F[q];
    // cof F; dJ/du_a = cof F dN_a,  g_a = cof F dN_a / J
    const P cof[9] = {f[4] * f[8] - f[5] * f[7], f[5] * f[6] - f[3] * f[8], f[3] * f[7] - f[4] * f[6],
                      f[2] * f[7] - f[1] * f[8], f[0] * f[8] - f[2] * f[6], f[1] * f[6] - f[0] * f[7],
                      f[1] * f[5] - f[2] * f[4], f[2] * f[3] - f[0] * f[5], f[0] * f[4] - f[1] * f[3]};
    const P inverse_J = 1.0 / J, w = geometry.w[q];
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i) {
        const P dJ = cof[3 * i] * dN[3 * a] + cof[3 * i + 1] * dN[3 * a + 1] + cof[3 * i + 2] * dN[3 * a + 2];
        g[q][a][i] = dJ * inverse_J;
        if (mean)
          b[3 * a + i] += w * dJ;
        else
          out.dJ_du[q][3 * a + i] = dJ;
      }
    if (mean) theta += w * J_minus_1[q];
  }
  P p, p_K;
  if (mean) {
    const P inverse_V = 1.0 / geometry.V;
    theta *= inverse_V;
    p = kappa * theta, p_K = p_tangent ? *p_tangent : p;
    out.J_minus_1[0] = theta;
    out.W += 0.5 * geometry.V * p * theta;
    for (int i = 0; i < 24; ++i) out.dJ_du[0][i] = b[i] * inverse_V, out.f[i] = p * b[i];
    if (with_tangent)
      for (int i = 0, k = 0; i < 24; ++i) {
        const P row = kappa * out.dJ_du[0][i];
        for (int j = 0; j <= i; ++j) out.K[k++] = row * b[j];
      }
  } else {
    for (int q = 0; q < 8; ++q) out.J_minus_1[q] = J_minus_1[q];
    for (P& f : out.f) f = P();
    if (with_tangent)
      for (P& k : out.K) k = P();
  }
  for (int q = 0; q < 8; ++q) {
    const P J = 1.0 + J_minus_1[q], w = geometry.w[q];
    Spatial s;
    law(material, F[q], J, fibres, s);
    out.W += w * s.W;
    P force[6];  // w times the Kirchhoff stress in the residual
    for (int i = 0; i < 6; ++i) force[i] = w * s.tau[i];
    P bulk;
    if (!mean) {
      p = kappa * J_minus_1[q], p_K = p_tangent ? p_tangent[q] : p;
      out.W += 0.5 * w * p * J_minus_1[q];
      for (int i = 0; i < 3; ++i) force[i] += w * p * J;
      bulk = kappa * J * J;
    }
    for (int a = 0; a < 8; ++a) {
      const P* ga = g[q][a];
      out.f[3 * a] += force[0] * ga[0] + force[3] * ga[1] + force[5] * ga[2];
      out.f[3 * a + 1] += force[3] * ga[0] + force[1] * ga[1] + force[4] * ga[2];
      out.f[3 * a + 2] += force[5] * ga[0] + force[4] * ga[1] + force[2] * ga[2];
    }
    if (!with_tangent) continue;
    const P pJ = p_K * J;
    P c[36], stress[6];
    tangent(s, pJ, bulk, w, c);
    for (int i = 0; i < 6; ++i) stress[i] = w * (i < 3 ? s.tau[i] + pJ : s.tau[i]);
    add_stiffness(g[q], c, stress, out.K);
  }
}

}  // namespace langer
