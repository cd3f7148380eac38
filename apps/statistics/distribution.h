/* Probability distributions, accurate to about 1e-12 by comparison with SciPy. All [any]. */
#ifndef ETHD__APPS_STATISTICS_DISTRIBUTION_H
#define ETHD__APPS_STATISTICS_DISTRIBUTION_H

/* P(Z <= z) of a standard normal number. */
double ethd__normal_below(double z);

/* P(T <= t) of Student's t with `freedom` degrees of freedom, and the t at which it is p. */
double ethd__student_below(double t, double freedom);
double ethd__student_quantile(double p, double freedom);

/* P(T <= t) of the noncentral t: (Z + shift)/sqrt(chi2/freedom). */
double ethd__noncentral_below(double t, double freedom, double shift);

/* P(X >= x) of chi square. */
double ethd__chi_square_above(double x, double freedom);

#endif
