# The mixed model of data/synthetic_population.csv by nlme (Pinheiro, Bates), for comparison.
#   Rscript tests/population/nlme.R data/synthetic_population.csv
# Prints: fixed effects, their standard errors, rows of the covariance of the random effects, sigma, ln L.
suppressWarnings(suppressMessages(library(nlme)))
d <- read.csv(commandArgs(TRUE)[1], comment.char = "#")
n <- nrow(d)
long <- data.frame(specimen = factor(c(d$specimen, d$specimen)), lx = c(d$lambda_x, d$lambda_x),
                   lz = c(d$lambda_z, d$lambda_z), along = rep(c(1, 0), each = n),
                   stress = c(d$P_x_MPa, d$P_z_MPa))
nominal <- function(lx, lz, along, la1, lc1, lc2, alpha) {
  a1 <- exp(la1); c1 <- exp(lc1); c2 <- exp(lc2); turn <- pi / 180
  co <- cos(alpha * turn); si <- sin(alpha * turn)
  ly <- 1 / (lx * lz)
  y <- pmax(0, (lx * co)^2 + (lz * si)^2 - 1)
  e <- exp(c2 * y^2)
  w4 <- c1 * y * e
  l <- ifelse(along == 1, lx, lz)
  g <- 2 * (l - ly^2 / l)
  part <- ifelse(along == 1, co^2, si^2)
  part_slope <- ifelse(along == 1, -2, 2) * co * si * turn
  y_slope <- ifelse(y > 0, 2 * (lz^2 - lx^2) * co * si * turn, 0)
  value <- a1 * g + 2 * w4 * l * part
  attr(value, "gradient") <- cbind(la1 = a1 * g, lc1 = 2 * w4 * l * part,
    lc2 = 2 * w4 * l * part * c2 * y^2,
    alpha = 2 * l * (c1 * e * (1 + 2 * c2 * y^2) * y_slope * part + w4 * part_slope))
  value
}
fit <- suppressWarnings(nlme(stress ~ nominal(lx, lz, along, la1, lc1, lc2, alpha), data = long,
  fixed = la1 + lc1 + lc2 + alpha ~ 1, random = pdSymm(la1 + lc1 + lc2 + alpha ~ 1),
  groups = ~specimen, start = c(log(0.012), log(0.06), log(1.2), 35), method = "ML",
  control = nlmeControl(tolerance = 1e-8, pnlsTol = 1e-8, msTol = 1e-12, maxIter = 200, msMaxIter = 500,
                        pnlsMaxIter = 100, returnObject = TRUE)))
options(digits = 12)
cat(fixef(fit), "\n")
cat(sqrt(diag(vcov(fit))), "\n")
C <- as.matrix(pdMatrix(fit$modelStruct$reStruct)[[1]]) * fit$sigma^2
for (i in 1:4) cat(C[i, ], "\n")
cat(fit$sigma, as.numeric(logLik(fit)), "\n")
