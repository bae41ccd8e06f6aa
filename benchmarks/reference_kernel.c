/* What benchmarks are compared with on whatever machine they run: velocities of straight vortex
   segments, K (a x b) with K = (|a| + |b|) / (|a| |b| (|a| |b| + a.b)), a and b from the ends of the
   segment to the point. One thread, 64 bit; a pair takes some 40 operations, two roots and one
   division. Coordinates are six separate vectors, so that compilers vectorise the inner loop. */
#include <math.h>

void velocities(int n_points, const double *restrict px, const double *restrict py,
                const double *restrict pz, int n, const double *restrict ax,
                const double *restrict ay, const double *restrict az, const double *restrict bx,
                const double *restrict by, const double *restrict bz, double *restrict velocity)
{
    for (int i = 0; i < n_points; i++) {
        const double x = px[i], y = py[i], z = pz[i];
        double u = 0.0, v = 0.0, w = 0.0;
        for (int j = 0; j < n; j++) {
            const double x1 = x - ax[j], y1 = y - ay[j], z1 = z - az[j];
            const double x2 = x - bx[j], y2 = y - by[j], z2 = z - bz[j];
            const double a2 = x1 * x1 + y1 * y1 + z1 * z1;
            const double b2 = x2 * x2 + y2 * y2 + z2 * z2;
            const double q = sqrt(a2 * b2), s = sqrt(a2 + b2 + 2.0 * q);
            const double k = s / (q * (q + x1 * x2 + y1 * y2 + z1 * z2));
            u += k * (y1 * z2 - z1 * y2);
            v += k * (z1 * x2 - x1 * z2);
            w += k * (x1 * y2 - y1 * x2);
        }
        velocity[3 * i] = u;
        velocity[3 * i + 1] = v;
        velocity[3 * i + 2] = w;
    }
}
