# Makes abdomen_socci2007_reconstructed.csv:
#   awk -f data/abdomen_socci2007_reconstructed.awk > data/abdomen_socci2007_reconstructed.csv
# Incompressible uniaxial tension along the fibre, I1 = lambda^2 + 2/lambda, I4 = lambda^2:
#   sigma = 2 (lambda^2 - 1/lambda) dW/dI1 + 2 lambda^2 dW/dI4
# with the HGO-Yeoh parameters of Table 1 of [A23].
BEGIN {
  a1 = 0.269; a2 = 0.376; a3 = 0.415; c1 = -0.317; c2 = 0.319
  print "# NOT MEASURED. Reconstructed from a model, because the measured points are not published as numbers."
  print "# Skin of the abdomen, uniaxial tension along the collagen fibres. The curve of Socci et al. (2007) was fitted in"
  print "# Alliliche, Renaud, Cros, Feng (2023), doi 10.1016/j.jmbbm.2023.105755, Table 1, by the HGO-Yeoh law with"
  printf "# a1 = %g MPa, a2 = %g MPa, a3 = %g MPa, c1 = %g MPa, c2 = %g;\n", a1, a2, a3, c1, c2
  print "# this is the incompressible uniaxial Cauchy stress of that law. The paper gives its distance to the measured points"
  print "# as 0.5 % (mean) and 2.5 % (largest) of the largest stress."
  print "# Made by abdomen_socci2007_reconstructed.awk. Strain is engineering strain, lambda - 1."
  print "strain,cauchy_stress_MPa"
  for (i = 0; i <= 30; ++i) {
    l = 1 + 0.02 * i
    x = l * l + 2 / l - 3
    y = l * l - 1
    dW1 = a1 + 2 * a2 * x + 3 * a3 * x * x
    dW4 = c1 * y * exp(c2 * y * y)
    printf "%.2f,%.6f\n", l - 1, 2 * (l * l - 1 / l) * dW1 + 2 * l * l * dW4
  }
}
