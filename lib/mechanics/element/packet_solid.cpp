#include "mechanics/element/packet_solid.hpp"

#include <algorithm>

#include "mechanics/element/dilatation.hpp"
#include "mechanics/element/spatial_terms.hpp"

namespace langer {

namespace {

using P = Packet;

template <int n>
void displacement_gradient(const P* dN, const P* u, P* H) {
  P sum[3][3]{};  // stays in registers
  for (int a = 0; a < n; ++a)
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) sum[i][k] += u[3 * a + i] * dN[3 * a + k];
  for (int i = 0; i < 9; ++i) H[i] = sum[i / 3][i % 3];
}

// J - 1 = tr H + i2(H) + det H
P dilatation(const P* H) {
  const P c0 = H[4] * H[8] - H[5] * H[7], c1 = H[5] * H[6] - H[3] * H[8],
          c2 = H[3] * H[7] - H[4] * H[6];
  const P i2 = H[0] * H[4] - H[1] * H[3] + c0 + H[8] * H[0] - H[6] * H[2];
  return (H[0] + H[4] + H[8]) + i2 + (H[0] * c0 + H[1] * c1 + H[2] * c2);
}

// What the law gives at one Gauss point, in the deformed state; components in the order of
// voigt.hpp.
struct Spatial {
  P tau[6];     // isochoric Kirchhoff stress
  P tau_trace;  // trace of sum 2 W' h, before the deviator is taken
  P W{};
  int n = 0;  // terms of the tangent  4 W'' dev h x dev h
  P h[1 + 4][6];
  P stiffness[1 + 4];
};

constexpr int most_families = 4;

// factors of the terms of an elastic law
struct AsTheyAre {
  static const P& matrix(const P& x) { return x; }
  static const P& fibres(const P& x) { return x; }
};
struct Times {
  const Amplified& by;
  P matrix(const P& x) const { return by.matrix * x; }
  P fibres(const P& x) const { return by.fibres * x; }
};

//   tau = dev sum 2 W' h,   h of spatial_terms.hpp; W' and W'' times their factors
template <class Factors>
void law(const Material& material, const P* F, const P& J, const PacketFibre* fibres,
         const Factors& factors, Spatial& out) {
  const auto deviator = [](const P* h, P* d) {
    const P mean = (h[0] + h[1] + h[2]) * (1.0 / 3);
    for (int p = 0; p < 6; ++p) d[p] = p < 3 ? h[p] - mean : h[p];
  };
  const SpatialState state(F, J, [&](std::size_t k, int i) { return fibres[k].a[i]; });
  P dW{}, ddW{}, sum[6];
  matrix_terms<P>(material, state, [&](OfI1, const Energy<P>& e) {
    out.W += e.W;
    dW += factors.matrix(e.dW);
    ddW += factors.matrix(e.ddW);
  });
  for (int p = 0; p < 6; ++p) sum[p] = 2.0 * dW * state.b[p];
  out.stiffness[0] = 4.0 * ddW;
  deviator(state.b, out.h[0]);
  out.n = 1;
  fibre_terms<P>(material, state, [&](const auto& family, const Energy<P>& e) {
    out.W += e.W;
    const P dW_k = factors.fibres(e.dW);
    for (int p = 0; p < 6; ++p) sum[p] += 2.0 * dW_k * family.h[p];
    out.stiffness[out.n] = 4.0 * factors.fibres(e.ddW);
    deviator(family.h, out.h[out.n++]);
  });
  out.tau_trace = sum[0] + sum[1] + sum[2];
  deviator(sum, out.tau);
}

// F H F^T: the Kirchhoff stress of a second Piola-Kirchhoff stress
void push_forward(const P* F, const P* H, P* tau) {
  const P full[3][3] = {{H[0], H[3], H[5]}, {H[3], H[1], H[4]}, {H[5], H[4], H[2]}};
  P FH[3][3];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      FH[i][k] = F[3 * i] * full[0][k] + F[3 * i + 1] * full[1][k] + F[3 * i + 2] * full[2][k];
  for (int p = 0; p < 6; ++p) {
    const int i = voigt_i[p], j = voigt_j[p];
    tau[p] = FH[i][0] * F[3 * j] + FH[i][1] * F[3 * j + 1] + FH[i][2] * F[3 * j + 2];
  }
}

// c = sum 4 W'' dev h x dev h + 2/3 tr (I - 1/3 1 x 1) - 2/3 (tau x 1 + 1 x tau) + p J (1 x 1 - 2
// I) + bulk 1 x 1,  times w
void tangent(const Spatial& s, const P& pJ, const P& bulk, const P& w, P* c) {
  const P al = (2.0 / 3) * s.tau_trace, same = w * (al - 2.0 * pJ),
          ones = w * (pJ + bulk - al * (1.0 / 3));
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

// The column of node b, a >= b:  K_ab = sum over Gauss points of  B_a^T (c B_b) + (g_a . s g_b) I,
// with s the full Kirchhoff stress times w. The sum stays in registers.
template <int n, int n_gauss>
void add_stiffness(int b, const P (*g)[n][3], const P (*c)[36], const P (*s)[6], P* K) {
  P cB[n_gauss][3][6];        // columns of c B_b
  P diagonal[n_gauss][3][3];  // of entry (j, j), against g_a: from c B_b and s g_b
  for (int q = 0; q < n_gauss; ++q) {
    const P* gb = g[q][b];
    for (int p = 0; p < 6; ++p) {
      const P* r = c[q] + 6 * p;
      cB[q][0][p] = r[0] * gb[0] + r[3] * gb[1] + r[5] * gb[2];
      cB[q][1][p] = r[1] * gb[1] + r[3] * gb[0] + r[4] * gb[2];
      cB[q][2][p] = r[2] * gb[2] + r[4] * gb[1] + r[5] * gb[0];
    }
    const P* t = s[q];
    const P sg[3] = {t[0] * gb[0] + t[3] * gb[1] + t[5] * gb[2],
                     t[3] * gb[0] + t[1] * gb[1] + t[4] * gb[2],
                     t[5] * gb[0] + t[4] * gb[1] + t[2] * gb[2]};
    constexpr int entry[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) diagonal[q][j][k] = cB[q][j][entry[j][k]] + sg[k];
  }
  for (int a = b; a < n; ++a) {
    P sum[3][3]{};
    for (int q = 0; q < n_gauss; ++q) {
      const P* ga = g[q][a];
      const P x = ga[0], y = ga[1], z = ga[2];
      for (int j = 0; j < 3; ++j) {
        const P *w = cB[q][j], *d = diagonal[q][j];
        sum[j][j] += d[0] * x + d[1] * y + d[2] * z;
        if (j != 0) sum[j][0] += w[0] * x + w[3] * y + w[5] * z;
        if (j != 1) sum[j][1] += w[1] * y + w[3] * x + w[4] * z;
        if (j != 2) sum[j][2] += w[2] * z + w[4] * y + w[5] * x;
      }
    }
    for (int j = 0; j < 3; ++j)
      for (int i = a == b ? j : 0; i < 3; ++i) {
        const int row = 3 * a + i;
        K[row * (row + 1) / 2 + 3 * b + j] += sum[j][i];
      }
  }
}

// What the parts of packet_solid_of share. They are inlined into it, so that sizes and pointers
// stay known to the compiler.
template <int n, int n_gauss>
struct PacketPoints {
  P F[n_gauss][9], g[n_gauss][n][3], J_minus_1[n_gauss];  // g_a = cof F dN_a / J
  P t[n_modes]{}, b[n_modes][3 * n];                      // integrals of mode (J - 1), mode dJ/du
};

// dJ/du of every point where n_modal is 0
template <int n, int n_gauss>
[[gnu::always_inline]] inline void kinematics(const PacketGeometry& geometry, const Packet* u,
                                              int n_modal, PacketPoints<n, n_gauss>& at,
                                              PacketElement& out) {
  constexpr int n_dofs = 3 * n;
  for (int k = 0; k < n_modal; ++k) std::fill(at.b[k], at.b[k] + n_dofs, P());
  out.J_min = P(1e300);
  for (int q = 0; q < n_gauss; ++q) {
    const P* dN = &geometry.dN_dX[q * n_dofs];
    P H[9];
    displacement_gradient<n>(dN, u, H);
    at.J_minus_1[q] = dilatation(H);
    const P J = 1.0 + at.J_minus_1[q];
    out.J_min = P(J.v < out.J_min.v ? J.v : out.J_min.v);
    for (int i = 0; i < 9; ++i) at.F[q][i] = i % 4 == 0 ? 1.0 + H[i] : H[i];
    const P* f = at.F[q];
    const P cof[9] = {
        f[4] * f[8] - f[5] * f[7], f[5] * f[6] - f[3] * f[8], f[3] * f[7] - f[4] * f[6],
        f[2] * f[7] - f[1] * f[8], f[0] * f[8] - f[2] * f[6], f[1] * f[6] - f[0] * f[7],
        f[1] * f[5] - f[2] * f[4], f[2] * f[3] - f[0] * f[5], f[0] * f[4] - f[1] * f[3]};
    const P inverse_J = 1.0 / J, w = geometry.w[q];
    P weight[n_modes] = {w};
    for (int k = 1; k < n_modal; ++k) weight[k] = w * geometry.mode[q * n_modes + k];
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < 3; ++i) {
        const P dJ = cof[3 * i] * dN[3 * a] + cof[3 * i + 1] * dN[3 * a + 1] +
                     cof[3 * i + 2] * dN[3 * a + 2];
        at.g[q][a][i] = dJ * inverse_J;
        if (n_modal > 0)
          for (int k = 0; k < n_modal; ++k) at.b[k][3 * a + i] += weight[k] * dJ;
        else
          out.dJ_du(q)[3 * a + i] = dJ;
      }
    for (int k = 0; k < n_modal; ++k) at.t[k] += weight[k] * at.J_minus_1[q];
  }
}

// dilatations and pressures of the whole cell: their energy, force and tangent; p: of the tangent
template <int n, int n_gauss>
[[gnu::always_inline]] inline void add_modal(const Material& material, const P& local,
                                             const PacketGeometry& geometry,
                                             const Packet* p_tangent, bool with_tangent, int n_p,
                                             const PacketPoints<n, n_gauss>& at, P* p,
                                             PacketElement& out) {
  constexpr int n_dofs = 3 * n;
  const P inverse_V = 1.0 / geometry.V;
  for (int k = 0; k < n_p; ++k) {
    out.J_minus_1[k] = at.t[k] * inverse_V;
    P* dJ = out.dJ_du(k);
    for (int i = 0; i < n_dofs; ++i) dJ[i] = at.b[k][i] * inverse_V;
  }
  const ModalVolume<P> volume = modal_volume(
      material.volume, n_p, out.J_minus_1.data(), local, geometry.V, n_gauss,
      [&](int q) { return geometry.w[q]; },
      [&](int q, int k) { return geometry.mode[q * n_modes + k]; });
  out.W += volume.W;
  for (int k = 0; k < n_p; ++k) {
    p[k] = p_tangent ? p_tangent[k] : volume.p[k];
    const P* dJ = out.dJ_du(k);
    for (int i = 0; i < n_dofs; ++i) out.f[i] += volume.p[k] * at.b[k][i];
    for (int i = 0, entry = 0; i < n_dofs && with_tangent; ++i) {
      P row = volume.kappa[k][k] * dJ[i];
      for (int l = 0; l < n_p && !volume.independent; ++l)
        if (l != k) row += volume.kappa[k][l] * out.dJ_du(l)[i];
      if (k == 0)
        for (int j = 0; j <= i; ++j) out.K[entry++] = row * at.b[k][j];
      else
        for (int j = 0; j <= i; ++j) out.K[entry++] += row * at.b[k][j];
    }
  }
}

template <int n, int n_gauss>
void packet_solid_of(Formulation formulation, const Material& material, const P& local,
                     const PacketGeometry& geometry, const PacketFibre* fibres, const Packet* u,
                     const Packet* p_tangent, bool with_tangent, PacketElement& out,
                     const PacketMemory* memory) {
  const bool modal = formulation != Formulation::displacement;
  const int n_p = n_pressures(formulation, n);
  PacketPoints<n, n_gauss> at;
  out.W = P();
  kinematics(geometry, u, modal ? n_p : 0, at, out);
  std::fill(out.f.begin(), out.f.end(), P());
  if (with_tangent && !modal) std::fill(out.K.begin(), out.K.end(), P());
  P p[n_modes];  // of the tangent
  if (modal)
    add_modal(material, local, geometry, p_tangent, with_tangent, n_p, at, p, out);
  else
    std::copy(at.J_minus_1, at.J_minus_1 + n_gauss, out.J_minus_1.begin());
  P c[n_gauss][36], stress[n_gauss][6];  // of the tangent
  for (int q = 0; q < n_gauss; ++q) {
    const P J = 1.0 + at.J_minus_1[q], w = geometry.w[q];
    Spatial s;
    P remembered[6];  // Kirchhoff stress
    if (memory) {
      law(material, at.F[q], J, fibres, Times{memory->amplified}, s);
      push_forward(at.F[q], memory->H + 6 * q, remembered);
    } else
      law(material, at.F[q], J, fibres, AsTheyAre{}, s);
    out.W += w * s.W;
    P force[6];  // w times the Kirchhoff stress in the residual
    for (int i = 0; i < 6; ++i) force[i] = w * s.tau[i];
    if (memory)
      for (int i = 0; i < 6; ++i) force[i] += w * remembered[i];
    P bulk{}, p_K{};
    if (modal) {
      p_K = p[0];
      for (int k = 1; k < n_p; ++k) p_K += p[k] * geometry.mode[q * n_modes + k];
    }
    if (!modal || formulation == Formulation::linear_dilatation) {
      const P x = at.J_minus_1[q];
      const Energy<P> U = modal ? Energy<P>{0.5 * local * x * x, local * x, local}
                                : volume_energy(material.volume, x);
      p_K += p_tangent && !modal ? p_tangent[q] : U.dW;
      out.W += w * U.W;
      for (int i = 0; i < 3; ++i) force[i] += w * U.dW * J;
      bulk = U.ddW * J * J;
    }
    for (int a = 0; a < n; ++a) {
      const P* ga = at.g[q][a];
      out.f[3 * a] += force[0] * ga[0] + force[3] * ga[1] + force[5] * ga[2];
      out.f[3 * a + 1] += force[3] * ga[0] + force[1] * ga[1] + force[4] * ga[2];
      out.f[3 * a + 2] += force[5] * ga[0] + force[4] * ga[1] + force[2] * ga[2];
    }
    if (!with_tangent) continue;
    const P pJ = p_K * J;
    tangent(s, pJ, bulk, w, c[q]);
    for (int i = 0; i < 6; ++i) stress[q][i] = w * (i < 3 ? s.tau[i] + pJ : s.tau[i]);
    if (memory)
      for (int i = 0; i < 6; ++i) stress[q][i] += w * remembered[i];
  }
  if (!with_tangent) return;
  for (int b = 0; b < n; ++b) add_stiffness<n, n_gauss>(b, at.g, c, stress, out.K.data());
}

}  // namespace

bool packet_form(const Material& material) {
  if (std::count_if(material.fibres.begin(), material.fibres.end(), acts) > most_families)
    return false;
  for (const MatrixTerm& term : material.matrix)
    if (!std::visit([]<class Law>(const Law&) { return Law::of == Invariant::I1_bar; }, term))
      return false;
  return true;
}

PacketElement::PacketElement(int n_nodes, int n_pressures)
    : n_dofs(3 * n_nodes),
      f(n_dofs),
      K(n_dofs * (n_dofs + 1) / 2),
      J_minus_1(n_pressures),
      gradients(n_pressures * n_dofs) {}

PacketGeometry packed(const ElementGeometry* const geometry[P::lanes]) {
  PacketGeometry out;
  out.n_nodes = geometry[0]->n_nodes();
  out.n_gauss = geometry[0]->n_gauss();
  out.dN_dX.resize(out.n_gauss * 3 * out.n_nodes), out.w.resize(out.n_gauss);
  out.mode.resize(n_modes * geometry[0]->mode.size());
  for (int l = 0; l < P::lanes; ++l) {
    for (int g = 0; g < out.n_gauss; ++g) {
      for (int a = 0; a < out.n_nodes; ++a)
        for (int k = 0; k < 3; ++k)
          out.dN_dX[3 * (g * out.n_nodes + a) + k].set(l, geometry[l]->dN_dX[g](a, k));
      out.w[g].set(l, geometry[l]->w[g]);
      for (int k = 0; k < n_modes && !out.mode.empty(); ++k)
        out.mode[g * n_modes + k].set(l, geometry[l]->mode[g][k]);
    }
    out.V.set(l, geometry[l]->V);
  }
  return out;
}

void packet_stress(const Material& material, const Packet F[9], const Packet& J,
                   std::span<const Vec3> a, Packet tau[6]) {
  std::vector<PacketFibre> fibres(a.size());
  for (std::size_t k = 0; k < a.size(); ++k)
    for (int i = 0; i < 3; ++i) fibres[k].a[i] = a[k][i];
  Spatial s;
  law(material, F, J, fibres.data(), AsTheyAre{}, s);
  std::copy(s.tau, s.tau + 6, tau);
}

void packet_dilatations(const PacketGeometry& geometry, const Packet* u, Packet* J_minus_1) {
  for (int q = 0; q < geometry.n_gauss; ++q) {
    P H[9];
    const P* dN = &geometry.dN_dX[q * 3 * geometry.n_nodes];
    with_cell(geometry.n_nodes,
              [&](auto cell) { displacement_gradient<decltype(cell)::n_nodes>(dN, u, H); });
    J_minus_1[q] = dilatation(H);
  }
}

void packet_solid(Formulation formulation, const Material& material, const Packet& local,
                  const PacketGeometry& geometry, const PacketFibre* fibres, const Packet* u,
                  const Packet* p_tangent, bool with_tangent, PacketElement& out,
                  const PacketMemory* memory) {
  with_cell(geometry.n_nodes, [&](auto cell) {
    packet_solid_of<decltype(cell)::n_nodes, decltype(cell)::n_gauss>(
        formulation, material, local, geometry, fibres, u, p_tangent, with_tangent, out, memory);
  });
}

}  // namespace langer
