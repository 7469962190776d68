// The drift mode of the dumbbell by Siconos: time stepping of Moreau and Jean, in the frame of the plate.
//
//     make dumbbell && OPENBLAS_NUM_THREADS=1 ./dumbbell STEP T_END nsgs
//
// It prints processor time per simulated second, drift over the second half, and the deepest penetration relative to the
// amplitude of the plate.  nsgs is the solver of contacts by sweeps; ac is Newton's method of Alart and Curnier.
#include "SiconosKernel.hpp"
#include <time.h>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include "SolverOptions.h"
#include "Friction_cst.h"
static double cpu() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}
static const double r = 0.00476;
struct Ball : public NewtonEuler3DR {
  double s;
  double deepest = 0;
  Ball(double S) : NewtonEuler3DR(), s(S) {
  }
  void computeh(double, const BlockVector &q, SiconosVector &y) override {
    double w = q.getValue(3), a = q.getValue(4), b = q.getValue(5), c = q.getValue(6);
    double ex = 1 - 2 * (b * b + c * c), ey = 2 * (a * b + w * c), ez = 2 * (a * c - w * b); // first body axis in space
    double X = q.getValue(0) + s * ex, Y = q.getValue(1) + s * ey, Z = q.getValue(2) + s * ez;
    y.setValue(0, Z - r);
    _Nc->setValue(0, 0);
    _Nc->setValue(1, 0);
    _Nc->setValue(2, 1);
    _Pc1->setValue(0, X);
    _Pc1->setValue(1, Y);
    _Pc1->setValue(2, Z - r);
    _Pc2->setValue(0, X);
    _Pc2->setValue(1, Y);
    _Pc2->setValue(2, 0);
    if (Z - r < deepest)
      deepest = Z - r;
  }
};
int main(int argc, char **argv) {
  try {
    double h = atof(argv[1]), T = atof(argv[2]);
    std::string sol = argv[3];
    double theta = argc > 4 ? atof(argv[4]) : 0.5;
    double m = 0.008291157021985057, Ia = 6.387162457605173e-08, It = 1.4406808496286491e-06, L = 0.027608,
           A = 0.0003578258921512801, w = 2 * M_PI * 25, g = 9.81, e = 0.65, mu = 0.2, tilt = M_PI / 18;
    double half = L / 2;
    if (getenv("RESTITUTION"))
      e = atof(getenv("RESTITUTION"));
    double c00 = cpu();
    SP::NonSmoothDynamicalSystem nsds(new NonSmoothDynamicalSystem(0, T));
    SP::SiconosVector q(new SiconosVector(7)), v(new SiconosVector(6));
    q->zero();
    v->zero();
    (*q)(0) = half * cos(tilt);
    (*q)(2) = r + half * sin(tilt);
    (*q)(3) = cos(-tilt / 2);
    (*q)(5) = sin(-tilt / 2);
    (*v)(2) = -A * w; // plate's velocity at t = 0 taken away
    SP::SimpleMatrix I(new SimpleMatrix(3, 3));
    I->zero();
    (*I)(0, 0) = Ia;
    (*I)(1, 1) = (*I)(2, 2) = It;
    SP::NewtonEulerDS d(new NewtonEulerDS(q, v, m, I));
    SP::SiconosVector F(new SiconosVector(3));
    F->zero();
    (*F)(2) = -m * g;
    d->setFExtPtr(F);
    nsds->insertDynamicalSystem(d);
    SP::NonSmoothLaw law(new NewtonImpactFrictionNSL(e, 0, mu, 3));
    std::shared_ptr<Ball> b[2];
    for (int k = 0; k < 2; k++) {
      b[k].reset(new Ball(k ? half : -half));
      SP::Relation R = b[k];
      SP::Interaction in(new Interaction(law, R));
      nsds->link(in, d);
    }
    SP::MoreauJeanOSI osi(new MoreauJeanOSI(theta));
    SP::TimeDiscretisation td(new TimeDiscretisation(0, h));
    int id = sol == "nsgs" ? SICONOS_FRICTION_3D_NSGS
             : sol == "ac" ? SICONOS_FRICTION_3D_NSN_AC
                           : SICONOS_FRICTION_3D_ADMM;
    SP::FrictionContact fc(new FrictionContact(3, id));
    double tol = getenv("TOL") ? atof(getenv("TOL")) : 1e-10;
    fc->numericsSolverOptions()->dparam[0] = tol;
    fc->numericsSolverOptions()->iparam[0] = 10000;
    SP::TimeStepping s(new TimeStepping(nsds, td, osi, fc));
    s->setNewtonTolerance(1e-10);
    s->setNewtonMaxIteration(20);
    if (getenv("LINEAR"))
      s->setNewtonOptions(SICONOS_TS_LINEAR);
    double deep = 0;
    double c0 = cpu();
    double t = 0;
    double st = 0, sx = 0, stt = 0, stx = 0;
    long n = 0;
    long steps = 0;
    auto set = [&](double t) { (*F)(2) = -m * g + m * A * w * w * sin(w * t); };
    set(0);
    while (s->hasNextEvent()) {
      set(t + h);
      s->computeOneStep();
      steps++;
      t = s->nextTime();
      {
        double qw = (*d->q())(3), qa = (*d->q())(4), qb = (*d->q())(5), qc = (*d->q())(6);
        double ez = 2 * (qa * qc - qw * qb);
        deep = std::min(deep, (*d->q())(2) - half * fabs(ez) - r);
      }
      double x = (*d->q())(0);
      if (t >= T / 2) {
        double tc = t - 0.75 * T;
        st += tc;
        sx += x;
        stt += tc * tc;
        stx += tc * x;
        n++;
      }
      s->nextStep();
    }
    double c1 = cpu();
    double slope = (n * stx - st * sx) / (n * stt - st * st);
    printf("dumbbell %s h %g theta %g T %g: setup %.2f ms, %.3f ms per s, drift %.4f mm/s, deepest/A %.3g, steps %ld, "
           "y %.2e\n",
           sol.c_str(), h, theta, T, 1e3 * (c0 - c00), 1e3 * (c1 - c0) / T, 1e3 * slope, -deep / A, steps,
           (*d->q())(1));
  } catch (std::exception &x) {
    printf("EXC %s\n", x.what());
    return 1;
  } catch (...) {
    printf("EXC\n");
    return 1;
  }
}
