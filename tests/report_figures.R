# The statistics of a report, worked out again from taps.csv and survey.csv with R's own functions.
#   Rscript report_figures.R STUDY     compares STUDY/report/*.csv: exact figures to 1e-9, drawn ones within their noise
study <- commandArgs(TRUE)[1]
read <- function(name) read.csv(file.path(study, name), na.strings = "", check.names = FALSE)
report <- function(name) read(file.path("report", name))
set.seed(7)
failed <- character(0); compared <- 0; worst <- 0
fail <- function(...) failed <<- c(failed, paste0(...))
same <- function(what, here, there, tolerance = 1e-9) {
  compared <<- compared + 1
  if (is.character(there) || is.character(here)) { if (!identical(as.character(here), as.character(there))) fail(what, ": found ", here, ", it should be ", there); return() }
  if (is.na(there) || is.na(here)) { if (is.na(there) != is.na(here)) fail(what, ": found ", here, ", it should be ", there); return() }
  off <- abs(here - there)/max(1, abs(there))
  if (off > tolerance) fail(what, ": found ", format(here, digits = 15), ", it should be ", format(there, digits = 15))
  else if (tolerance == 1e-9) worst <<- max(worst, off)
}

# ---- taps ----

taps <- read("taps.csv")
taps <- taps[taps$part == "test", ]
for (name in c("v_hand_mps", "touch_depth_m", "eps_felt_m")) if (is.null(taps[[name]])) taps[[name]] <- NA
taps <- within(taps, {
  v_rvo <- v_rvo_mps; v_of <- v_of_mps; d_max <- 1e3*d_max_m; v_rmin <- v_rmin_mps; delta_s <- delta_s_ms; eps <- 1e3*eps_m
  delay <- 1e3*(t_of_s - t_seen_s); peak_force <- peak_force_n; v_hand <- v_hand_mps; touch_depth <- 1e3*touch_depth_m; eps_felt <- 1e3*eps_felt_m
  size_of <- abs(v_of); size_rmin <- abs(v_rmin); with_finger <- 100*(v_of > 0); brief <- 100*(delta_s < 20); shallow <- 100*(eps < 3)
})
people <- unique(taps$participant)
ok <- taps$reason == "ok"
# one number for each person in a cell, in the order of `people`
own <- function(figure, law, speed, how = median, rows = ok) {
  here <- rows & taps$transition == law & taps$speed == speed & !is.na(figure)
  as.vector(tapply(figure[here], factor(taps$participant[here], people), how))
}
margin <- c(d_max = 0.3, v_of = 0.02, v_rmin = 0.02)

# ---- tests ----

flip <- function(x) { # Fisher's, of all signs up to sixteen people
  n <- length(x)
  if (n < 6) return(c(NA, 1e-9))
  if (n <= 16) { sums <- 0; for (v in x) sums <- c(sums - v, sums + v); return(c(mean(abs(sums) >= abs(sum(x)) - 1e-9*sum(abs(x))), 1e-9)) }
  sums <- abs(matrix(sample(c(-1, 1), 20000*n, TRUE), 20000) %*% x)
  p <- (1 + sum(sums >= abs(sum(x)) - 1e-9*sum(abs(x))))/20001
  c(p, 5*sqrt(p*(1 - p)/1e4) + 4e-4)
}
ends <- function(x, level) if (length(x) < 3) c(NA, NA) else if (sd(x) == 0) rep(mean(x), 2) else t.test(x, conf.level = level)$conf.int
effect <- function(x) { # of d_z, from the noncentral t
  n <- length(x)
  if (n < 3 || !(sd(x) > 0)) return(c(NA, NA))
  t <- mean(x)/sd(x)*sqrt(n)
  suppressWarnings(sapply(c(0.975, 0.025), function(p) uniroot(function(s) pt(t, n - 1, s) - p, t + c(-1, 1)*(10 + abs(t)), tol = 1e-13)$root))/sqrt(n)
}
alike <- function(x, low, high) if (length(x) < 6) NA else
  max(t.test(x, mu = low, alternative = "greater")$p.value, t.test(x, mu = high, alternative = "less")$p.value)
holm <- function(what, rows) for (k in seq_len(nrow(rows))) same(paste(what, k, "Holm"), rows$p_holm[k], p.adjust(rows$p, "holm")[k])
cliff <- function(a, b) mean(sign(outer(b, a, "-")))
# people are drawn, then taps of each; sides: a list of people's taps for each sample
bootstrap <- function(sides, figure) {
  drawn <- replicate(1500, {
    who <- sample(length(people), replace = TRUE)
    taken <- lapply(sides, function(side) unlist(lapply(side[who], function(v) if (length(v)) v[sample.int(length(v), replace = TRUE)])))
    if (any(lengths(taken) == 0)) NA else do.call(figure, taken)
  })
  quantile(drawn[!is.na(drawn)], c(0.01, 0.045, 0.955, 0.99))
}
within_noise <- function(what, low, high, q) {
  compared <<- compared + 1
  if (!(q[1] <= low && low <= q[2] && q[3] <= high && high <= q[4])) fail(what, ": ", low, " to ", high, ", of R's draws ", paste(q, collapse = " "))
}
of_people <- function(figure, law, speed) {
  here <- ok & taps$transition == law & taps$speed == speed & !is.na(figure)
  split(figure[here], factor(taps$participant[here], unique(taps$participant[here])), drop = TRUE)[people]
}

# ---- tables ----

rows <- report("summary.csv")
for (k in seq_len(nrow(rows))) {
  r <- rows[k, ]; figure <- taps[[r$metric]]
  here <- ok & taps$transition == r$transition & taps$speed == r$speed & !is.na(figure)
  x <- figure[here]; what <- paste("summary", r$metric, r$transition, r$speed)
  there <- c(n = length(x), participants = length(unique(taps$participant[here])), mean = mean(x), sd = sd(x), min = min(x), max = max(x),
             q1 = quantile(x, 0.25, names = FALSE), median = median(x), q3 = quantile(x, 0.75, names = FALSE))
  for (name in names(there)) same(paste(what, name), r[[name]], there[[name]])
  if (r$metric %in% c("d_max", "delta_s") && there["participants"] >= 6 && length(people) < 30)
    within_noise(paste(what, "median's interval"), r$median_low, r$median_high, bootstrap(list(of_people(figure, r$transition, r$speed)), median))
}

difference <- function(what, r, x, mean_name) {
  p <- flip(x)
  there <- c(participants = length(x), positive = sum(x > 0), mean = mean(x), sd = sd(x), median = median(x), mean_low = ends(x, 0.95)[1],
             mean_high = ends(x, 0.95)[2], d_z = if (length(x) > 1 && sd(x) > 0) mean(x)/sd(x) else NA, d_z_low = effect(x)[1], d_z_high = effect(x)[2])
  for (name in names(there)) {
    if (grepl("d_z_", name) && !is.na(there[[name]]) && abs(there[[name]])*sqrt(length(x)) > 37) next # R's noncentral t is approximate there
    same(paste(what, name), r[[if (name == "mean") mean_name else name]], there[[name]])
  }
  same(paste(what, "p"), r$p, p[1], p[2])
}
pairs <- report("pairs.csv")
for (k in seq_len(nrow(pairs))) {
  r <- pairs[k, ]; figure <- taps[[r$metric]]; what <- paste("pairs", r$metric, r$transition_b, r$transition_a, r$speed)
  x <- own(figure, r$transition_b, r$speed) - own(figure, r$transition_a, r$speed)
  x <- x[!is.na(x)]
  difference(what, r, x, "mean_b_minus_a")
  m <- margin[r$metric]
  same(paste(what, "alike"), r$p_equivalent, if (is.na(m)) NA else alike(x, -m, m))
  for (end in 1:2) same(paste(what, "90 %", end), r[[c("mean_low_90", "mean_high_90")[end]]], if (is.na(m) || length(x) < 6) NA else ends(x, 0.9)[end])
  sides <- list(of_people(figure, r$transition_a, r$speed), of_people(figure, r$transition_b, r$speed))
  same(paste(what, "Cliff"), r$cliff_delta, cliff(unlist(sides[[1]]), unlist(sides[[2]])))
  if (r$metric == "d_max" && length(people) >= 6 && length(people) < 30)
    within_noise(paste(what, "Cliff's interval"), r$cliff_low, r$cliff_high, bootstrap(sides, cliff))
}
holm("pairs", pairs)
declared <- file.path("report", "primary.csv")
if (file.exists(file.path(study, declared))) {
  rows <- read(declared); power <- tail(readLines(file.path(study, "power.txt")), 2)
  same("primary outcomes", paste(rows$metric, rows$transition_b, rows$transition_a, rows$speed), c("d_max smooth offset high", "v_of offset smooth low"))
  for (k in 1:2) {
    r <- rows[k, ]; figure <- taps[[r$metric]]
    x <- own(figure, r$transition_b, r$speed) - own(figure, r$transition_a, r$speed); x <- x[!is.na(x)]
    difference(paste("primary", k), r, x, "mean_b_minus_a")
    reached <- function(n) power.t.test(n, mean(x), sd(x), 0.025, type = "paired")$power >= 0.8
    below <- 6; n <- 10000 # 2^(1 - 7) is the first p of signs under 0.025
    while (n - below > 1) { middle <- (n + below) %/% 2; if (reached(middle)) n <- middle else below <- middle }
    same(paste("participants needed", k), as.numeric(sub(".* ", "", power[k])), n)
  }
  holm("primary", rows)
}
rows <- report("interaction.csv")
for (k in seq_len(nrow(rows))) {
  r <- rows[k, ]; figure <- taps[[r$metric]]
  x <- own(figure, r$transition_b, r$speed) - own(figure, r$transition_a, r$speed) -
    (own(figure, r$transition_b, r$less_speed) - own(figure, r$transition_a, r$less_speed))
  difference(paste("interaction", r$metric, r$transition_b, r$transition_a), r, x[!is.na(x)], "mean")
}
holm("interaction", rows)

rows <- report("table1.csv")
for (k in seq_len(nrow(rows))) {
  r <- rows[k, ]; x <- own(taps[[r$metric]], "offset", r$speed, mean); x <- x[!is.na(x)]; what <- paste("table 1", r$metric, r$speed)
  if (length(x) < 6) next
  own_error <- var(x)/length(x); error <- r$paper_sd^2/9; d <- mean(x) - r$paper_mean # Welch's t test
  f <- (own_error + error)^2/(own_error^2/(length(x) - 1) + error^2/8)
  all <- taps[[r$metric]][ok & taps$transition == "offset" & taps$speed == r$speed]; all <- all[!is.na(all)]
  below <- pf(var(all)/r$paper_sd^2, length(all) - 1, 8)
  there <- c(people = length(x), people_mean = mean(x), people_low = ends(x, 0.95)[1], people_high = ends(x, 0.95)[2], difference = d,
             difference_low = d - qt(0.975, f)*sqrt(own_error + error), difference_high = d + qt(0.975, f)*sqrt(own_error + error),
             p_mean = 2*pt(-abs(d)/sqrt(own_error + error), f), sd_ratio = sd(all)/r$paper_sd, p_sd = 2*min(below, 1 - below))
  for (name in names(there)) same(paste(what, name), r[[name]], there[[name]])
}

# ---- the paper's sentences ----

sl <- c("smooth", "low"); ol <- c("offset", "low"); sh <- c("smooth", "high"); oh <- c("offset", "high")
at <- function(figure, cell, ...) own(taps[[figure]], cell[1], cell[2], ...)
valid <- function(cell) own(100*ok, cell[1], cell[2], mean, TRUE)
inter <- function(figure) list(low = -(at(figure, sl) - at(figure, ol)), high = at(figure, sh) - at(figure, oh))
contrasts <- list(
  at("d_max", ol) - at("d_max", sl), at("v_of", ol) - at("v_of", sl), at("v_rmin", ol) - at("v_rmin", sl),
  at("d_max", sh) - 3*at("d_max", oh), at("size_rmin", sh) - 2*at("size_rmin", oh), at("size_of", sh) - at("size_of", oh),
  at("with_finger", oh, mean), inter("d_max"), inter("size_of"), inter("size_rmin"), (valid(sh) + valid(oh))/2,
  at("brief", ol, mean), at("brief", oh, mean), at("shallow", ol, mean), at("shallow", oh, mean))
overlap <- function(x, y) { # Derrick and others 2017
  a <- x[!is.na(x)]; b <- y[!is.na(y)]; whole <- !is.na(x + y); n <- length(a); m <- length(b); c <- sum(whole)
  if (min(n, m) < 6) return(rep(NA, 4))
  r <- if (c > 2) cor(x[whole], y[whole]) else 0
  va <- var(a)/n; vb <- var(b)/m
  welch <- (va + vb)^2/(va^2/(n - 1) + vb^2/(m - 1)); f <- c - 1 + (welch - c + 1)/(n + m)*(n + m - 2*c)
  e <- sqrt(va + vb - 2*r*sqrt(va*vb)*c/sqrt(n*m)); d <- mean(a) - mean(b)
  c(d, d + qt(c(0.025, 0.975), f)*e, 2*pt(-abs(d)/e, f))
}
claims <- report("claims.csv")
ps <- rep(0, 10); against <- rep(1, 10); parts <- table(claims$claim); overlaps <- 0
for (k in seq_along(contrasts)) {
  r <- claims[k, ]; x <- contrasts[[k]]; what <- paste("claim", r$claim, r$contrast)
  both <- if (is.list(x)) x$low + x$high else x
  y <- both[!is.na(both)]
  if (is.list(x) && length(y) < 6) {
    o <- overlap(x$high, -x$low); overlaps <- overlaps + !is.na(o[4])
    if (!is.na(o[4])) for (i in 1:4) same(paste(what, "overlap", i), r[[c("mean", "low", "high", "p")[i]]], o[i])
    ps[r$claim] <- max(ps[r$claim], if (is.na(o[1]) || o[1] > 0) o[4] else 1)
    against[r$claim] <- min(against[r$claim], if (is.na(o[1]) || o[1] <= 0) o[4] else 1)
    next
  }
  same(paste(what, "n"), r$participants, length(y)); same(paste(what, "mean"), r$mean, mean(y))
  for (i in 1:2) same(paste(what, "end", i), r[[c("low", "high")[i]]], ends(y, 0.95)[i])
  if (!is.na(r$from) && !is.na(r$to)) {
    p <- alike(y, r$from, r$to); same(paste(what, "TOST"), r$p, p)
    contrary <- if (is.na(p)) NA else if (sd(y) == 0) as.numeric(mean(y) > r$from && mean(y) < r$to) else
      min(1, 2*min(t.test(y, mu = r$from, alternative = "less")$p.value, t.test(y, mu = r$to, alternative = "greater")$p.value))
  } else {
    z <- if (is.na(r$to)) y - r$from else r$to - y
    p <- flip(z); same(paste(what, "sign flip"), r$p, p[1], p[2]); p <- if (is.na(r$p) || mean(z) > 0) r$p else 1
    contrary <- if (is.na(r$p) || mean(z) <= 0) r$p else 1
  }
  ps[r$claim] <- max(ps[r$claim], p); against[r$claim] <- min(against[r$claim], contrary)
}
r <- claims[nrow(claims), ]
speed <- sort(unique(taps$commanded_mps)); early <- taps$reason == "early-contact"
cuts <- (head(speed, -1) + tail(speed, -1))/2
mistakes <- sapply(cuts, function(cut) sum(!early & taps$commanded_mps > cut) + sum(early & taps$commanded_mps < cut))
same("the threshold of early touches", r$mean, cuts[which.min(mistakes)])
ps[10] <- r$p
against <- pmin(1, against*as.vector(parts)); against[is.na(ps)] <- NA; against[10] <- r$p_contrary
first <- claims[match(1:10, claims$claim), ]
for (k in 1:10) { same(paste("claim", k, "p"), first$p_claim[k], ps[k]); same(paste("claim", k, "Holm"), first$p_holm[k], p.adjust(ps, "holm")[k])
  same(paste("claim", k, "contrary"), first$p_contrary[k], against[k]); same(paste("claim", k, "contrary, Holm"), first$p_contrary_holm[k], p.adjust(against, "holm")[k])
  verdict <- if (is.na(ps[k])) "too few people" else if (p.adjust(ps, "holm")[k] < 0.05) "shown" else if (p.adjust(against, "holm")[k] < 0.05) "the contrary is shown" else "not shown"
  same(paste("claim", k, "verdict"), first$verdict[k], verdict) }

# ---- the survey ----

asked <- file.path(study, "report", "survey-tests.csv")
if (file.exists(asked)) {
  survey <- read("survey.csv"); rows <- report("survey-tests.csv")
  given <- function(q, law, speed) { v <- survey[survey$transition == law & survey$speed == speed, ]; v[[paste0("q", q)]][match(people, v$participant)] }
  pratt <- function(x) { # exact, with zeros and ties
    rank <- rank(abs(x)); used <- round(2*rank[x != 0]); above <- sum(rank[x > 0]); share <- 1
    if (!length(used)) return(NA)
    for (step in used) share <- (c(share, rep(0, step)) + c(rep(0, step), share))/2
    i <- round(2*above) + 1
    min(1, 2*min(sum(share[1:i]), sum(share[i:length(share)])))
  }
  for (k in seq_len(nrow(rows))) {
    r <- rows[k, ]; what <- paste("survey", r$question, r$test, r$speed)
    if (r$test == "Friedman") {
      m <- sapply(c("abrupt", "smooth", "offset"), function(law) given(r$question, law, r$speed)); m <- m[complete.cases(m), ]
      f <- friedman.test(m)
      same(paste(what, "chi square"), r$statistic, unname(f$statistic)); same(paste(what, "p"), r$p, f$p.value); same(paste(what, "n"), r$n, nrow(m))
      next
    }
    x <- given(r$question, r$transition_b, r$speed) - given(r$question, r$transition_a, r$speed); x <- x[!is.na(x)]
    rank <- rank(abs(x))
    same(paste(what, "n"), r$n, length(x)); same(paste(what, "W"), r$statistic, min(sum(rank[x > 0]), sum(rank[x < 0])))
    same(paste(what, "p"), r$p, if (length(x) < 6) NA else pratt(x))
    if (length(x) >= 6 && !any(x == 0) && !any(duplicated(abs(x)))) same(paste(what, "wilcox.test"), r$p, wilcox.test(x, exact = TRUE)$p.value)
  }
  holm("survey", rows)
}

for (line in head(failed, 12)) cat("FAILED", line, "\n")
cat(sprintf("%d figures of %s in R: %d differ; exact ones by %.1e at most; %d tests of people who overlap\n", compared, basename(study), length(failed), worst, overlaps))
quit(status = as.integer(length(failed) > 0 || compared < 500))
