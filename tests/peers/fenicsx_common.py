"""What the FEniCSx scripts share: the isochoric energy of a law, and Newton's method with step halving and MUMPS."""
import numpy as np
import ufl
from dolfinx import fem
from dolfinx.fem import petsc
from mpi4py import MPI
from petsc4py import PETSc

FAST = {"cffi_extra_compile_args": ["-O3", "-march=native"]}


def isochoric_energy(F, law):
    """of Yeoh's matrix, and of fibres where the law has some"""
    J = ufl.det(F)
    I1 = J ** (-2 / 3) * ufl.inner(F, F) - 3
    energy = sum(a * I1 ** (i + 1) for i, a in enumerate(law["a"]))
    if "c1" in law:
        alpha = np.radians(law["alpha"])
        fibre = F * ufl.as_vector((np.cos(alpha), 0.0, np.sin(alpha)))
        stretched = J ** (-2 / 3) * ufl.inner(fibre, fibre) - 1
        stretched = ufl.conditional(ufl.gt(stretched, 0), stretched, 0)
        energy += law["c1"] / (2 * law["c2"]) * (ufl.exp(law["c2"] * stretched**2) - 1)
    return energy


class Newton:
    """lifted: some of what is held moves; else it is zero and stays so"""

    def __init__(self, residual, w, conditions, lifted):
        self.w, self.conditions, self.lifted = w, conditions, lifted
        self.linear, self.bilinear = (fem.form(f, jit_params=FAST) for f in (residual, ufl.derivative(residual, w)))
        self.matrix = petsc.create_matrix(self.bilinear)
        self.right, self.step = petsc.create_vector(self.linear), petsc.create_vector(self.linear)
        self.factor = PETSc.KSP().create(MPI.COMM_WORLD)
        self.factor.setOperators(self.matrix)
        self.factor.setType("preonly")
        self.factor.getPC().setType("lu")
        self.factor.getPC().setFactorSolverType("mumps")

    def assembled(self):
        """the residual without conditions"""
        with self.right.localForm() as values:
            values.set(0)
        petsc.assemble_vector(self.right, self.linear)
        return self.right

    def unbalanced(self):
        right = self.assembled()
        if self.lifted:
            petsc.apply_lifting(right, [self.bilinear], [self.conditions], [self.w.vector], -1.0)
        fem.set_bc(right, self.conditions, self.w.vector, -1.0)
        return right.norm()

    def solve(self):
        w, tolerance = self.w, 1e-6  # N
        size = self.unbalanced()
        for _ in range(25):
            if not np.isfinite(size):
                return False
            self.matrix.zeroEntries()
            petsc.assemble_matrix(self.matrix, self.bilinear, self.conditions)
            self.matrix.assemble()
            self.factor.solve(self.right, self.step)
            here, part = w.x.array.copy(), 1.0
            while True:
                w.x.array[:] = here - part * self.step.array
                new = self.unbalanced()
                if new < size or (part == 1 and np.isfinite(new) and new < 1e-6) or part < 0.05:
                    break
                part /= 2
            size = new
            if part == 1 and np.abs(self.step.array).max() < 1e-2 and size < tolerance:
                return True
        return False
