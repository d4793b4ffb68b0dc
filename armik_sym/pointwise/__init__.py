"""One pose after another: Pro-ISADE, ISADE, Levenberg-Marquardt, Sugihara and Al-Faiz."""
