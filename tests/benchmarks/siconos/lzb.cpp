// One multiple impact by Siconos, by the law of Liu, Zhao and Brogliato without friction.
//
//     make lzb && OPENBLAS_NUM_THREADS=1 ./lzb chain N STEP E ETA
//
// The step is an impulse [N s].  Kinds are chain (a row of N balls that one strikes), column (N beads dropped on a
// wall) and disc (a disc into two others).  It prints velocities after the impact and its processor time.
#include "SiconosKernel.hpp"
#include <chrono>
#include <time.h>
#include <cstdio>
#include <cstdlib>
#include <iostream>
static double cpu() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}
static double spent = 0;
static int calls = 0;
class Timed : public MultipleImpact {
public:
  Timed(std::string s, double d) : MultipleImpact(s, d) {
  }
  int compute(double t) override {
    double a = cpu();
    int r = MultipleImpact::compute(t);
    double d = cpu() - a;
    if (getenv("EACH"))
      printf("impact t %.10f cpu_ms %.4f\n", t, 1e3 * d);
    spent += d;
    calls++;
    return r;
  }
};
int main(int argc, char **argv) {
  try {
    std::string kind = argv[1];
    int N = atoi(argv[2]);
    double dP = atof(argv[3]), e = atof(argv[4]), eta = atof(argv[5]);
    double T = argc > 6 ? atof(argv[6]) : 0.3;
    double t0 = 0, R = getenv("RR") ? atof(getenv("RR")) : (kind == "column" ? 0.005 : 0.01),
           rho = kind == "disc" ? 7800 : 7780;
    double m = 4. / 3 * M_PI * R * R * R * rho;
    double E = 203e9, nu = 0.3;
    double k = 2. / 3 * E / (1 - nu * nu) * sqrt(R / 2);
    double g = kind == "column" ? 9.81 : 0;
    int dof = kind == "disc" ? 2 : 1;
    SP::NonSmoothDynamicalSystem nsds(new NonSmoothDynamicalSystem(t0, T));
    std::vector<SP::LagrangianLinearTIDS> b;
    double h0 = 0.05, dist = getenv("RR") ? R : 0.01, alpha = M_PI / 6;
    for (int i = 0; i < N; i++) {
      SP::SiconosVector q(new SiconosVector(dof)), v(new SiconosVector(dof));
      q->zero();
      v->zero();
      if (kind == "chain") {
        (*q)(0) = i == 0 ? -dist : 2 * R * i;
        (*v)(0) = i == 0 ? 1 : 0;
      }
      if (kind == "column") {
        (*q)(0) = h0 + R + 2 * R * i;
      }
      if (kind == "disc") {
        if (i == 0) {
          (*q)(0) = 0;
          (*q)(1) = -2 * R * cos(alpha) - dist;
          (*v)(1) = 1;
        } else
          (*q)(0) = i == 1 ? -R : R;
      }
      SP::SiconosMatrix M(new SimpleMatrix(dof, dof));
      M->zero();
      for (int j = 0; j < dof; j++)
        (*M)(j, j) = m;
      SP::LagrangianLinearTIDS d(new LagrangianLinearTIDS(q, v, M));
      SP::SiconosVector F(new SiconosVector(dof));
      F->zero();
      (*F)(dof - 1) = -m * g;
      d->setFExtPtr(F);
      b.push_back(d);
      nsds->insertDynamicalSystem(d);
    }
    if (kind == "chain" || kind == "column")
      for (int j = (kind == "column" ? -1 : 0); j < N - 1; j++) {
        SP::SimpleMatrix H(new SimpleMatrix(1, j < 0 ? 1 : 2));
        SP::SiconosVector c(new SiconosVector(1));
        if (j < 0) {
          (*H)(0, 0) = 1;
          (*c)(0) = -R;
        } else {
          (*H)(0, 0) = -1;
          (*H)(0, 1) = 1;
          (*c)(0) = -2 * R;
        }
        SP::NonSmoothLaw law(new MultipleImpactNSL(e, j < 0 ? k * sqrt(2.) : k, eta));
        SP::Relation rel(new LagrangianLinearTIR(H, c));
        SP::Interaction I(new Interaction(law, rel));
        if (j < 0)
          nsds->link(I, b[0]);
        else
          nsds->link(I, b[j], b[j + 1]);
      }
    else {
      double nx = sin(alpha), ny = cos(alpha);
      int pa[3] = {0, 0, 1}, pb[3] = {1, 2, 2};
      double n[3][2] = {{-nx, ny}, {nx, ny}, {1, 0}};
      for (int j = 0; j < 3; j++) {
        SP::SimpleMatrix H(new SimpleMatrix(1, 4));
        for (int a = 0; a < 2; a++) {
          (*H)(0, a) = -n[j][a];
          (*H)(0, 2 + a) = n[j][a];
        }
        SP::SiconosVector c(new SiconosVector(1));
        (*c)(0) = -2 * R;
        SP::NonSmoothLaw law(new MultipleImpactNSL(e, k, eta));
        SP::Relation rel(new LagrangianLinearTIR(H, c));
        SP::Interaction I(new Interaction(law, rel));
        nsds->link(I, b[pa[j]], b[pb[j]]);
      }
    }
    SP::OneStepIntegrator osi(new LsodarOSI());
    SP::TimeDiscretisation td(new TimeDiscretisation(t0, 1e-3));
    std::shared_ptr<Timed> imp(new Timed("BiStiffness", dP));
    imp->SetNstepMax(100000000);
    imp->SetSizeDataSave(1);
    if (getenv("TOL")) {
      double tl = atof(getenv("TOL"));
      imp->SetTolEner(tl);
      imp->SetZeroEnerEndImp(tl);
    }
    SP::OneStepNSProblem acc(new LCP());
    SP::EventDriven s(new EventDriven(nsds, td));
    s->insertIntegrator(osi);
    s->insertNonSmoothProblem(imp, SICONOS_OSNSP_ED_IMPACT);
    s->insertNonSmoothProblem(acc, SICONOS_OSNSP_ED_SMOOTH_ACC);
    int first = 0;
    double c0 = cpu();
    while (s->hasNextEvent()) {
      s->advanceToEvent();
      s->processEvents();
      if (calls > 0 && !first) {
        first = 1;
        printf("first impact at %.10f cpu_ms %.4f\nv", s->startingTime(), 1e3 * spent);
        for (auto &d : b)
          for (int a = 0; a < dof; a++)
            printf(" %.9f", (*d->velocity())(a));
        printf("\n");
        double k0 = 0.5 * m, k1 = 0, p = 0;
        for (auto &d : b)
          for (int a = 0; a < dof; a++) {
            k1 += 0.5 * m * pow((*d->velocity())(a), 2);
            p += (*d->velocity())(a);
          }
        printf("energy/start %.12f momentum %.12f\n", k1 / k0, p);
        if (argc <= 6)
          break;
      }
    }
    double ke = 0;
    for (auto &d : b)
      for (int a = 0; a < dof; a++)
        ke += 0.5 * m * (*d->velocity())(a) * (*d->velocity())(a);
    printf("t %.4f impacts %d impact_cpu_ms %.4f run_cpu_ms %.4f\n", s->startingTime(), calls, 1e3 * spent,
           1e3 * (cpu() - c0));
  } catch (std::exception &x) {
    printf("EXC %s\n", x.what());
    return 1;
  } catch (...) {
    printf("EXC ?\n");
    return 1;
  }
}
