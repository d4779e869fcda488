/*
 * cognate_routines.h: routines that compute what USER(...) stands for, written in C.
 *
 * A library of them is loaded by `cognate run model.adm --routines ./forces.so`, linked without
 * anything of ours: `cc -shared -fPIC -I include forces.c -o forces.so`. docs/routines.md tells
 * when they are called and what they may ask.
 *
 * The names of the structures and the order and types of their members are those of the C
 * interface of Adams Solver (slv_c_utils.h), so that a library compiled for one runs with the
 * other; the texts that `Type`, `Which` and `DVA` of a motion and `Type` of a force have are ours.
 * A number that an element does not have is 0.
 *
 * A routine has a name in mixed case (Sfosub, MyDamper). One in small letters or in capitals is
 * taken for one of Fortran, whose arguments are all addresses:
 *
 *     void sfosub_(const int *id, const double *time, const double *par, const int *npar,
 *                  const int *dflag, const int *iflag, double *value);
 */
#ifndef COGNATE_ROUTINES_H
#define COGNATE_ROUTINES_H

#ifdef __cplusplus
extern "C" {
#endif

/* Structures begin with the number of the element and the numbers of USER. */

/* SFORCE */
struct sAdamsSforce {
    int ID;
    int NPAR;
    const double *PAR;
    int I;
    int J;
    int ACTION_ONLY;  /* 1: nothing feels the reaction */
    const char *Type; /* "TRANSLATION", "ROTATION" */
};

/* VFORCE */
struct sAdamsVforce {
    int ID;
    int NPAR;
    const double *PAR;
    int I;
    int JFLOAT;
    int RM;
};

/* VTORQUE */
struct sAdamsVtorque {
    int ID;
    int NPAR;
    const double *PAR;
    int I;
    int JFLOAT;
    int RM;
};

/* GFORCE: mind the order of RM and JFLOAT */
struct sAdamsGforce {
    int ID;
    int NPAR;
    const double *PAR;
    int I;
    int RM;
    int JFLOAT;
};

/* VARIABLE */
struct sAdamsVariable {
    int ID;
    int NPAR;
    const double *PAR;
    double IC;
};

/* DIFF */
struct sAdamsDiff {
    int ID;
    int NPAR;
    const double *PAR;
    int STATIC_HOLD;
    int IMPLICIT;
    double IC_R1; /* the value at the start */
    double IC_R2; /* its rate */
};

/* MOTION, of a joint or between two markers */
struct sAdamsMotion {
    int ID;
    int NPAR;
    const double *PAR;
    int JOINT;
    const char *Type; /* "TRANSLATION", "ROTATION" */
    int I;
    int J;
    char Which[2];   /* X, Y, Z, B1, B2, B3 between markers; T, R or nothing of a joint */
    const char *DVA; /* "DISPLACEMENT", "VELOCITY", "ACCELERATION" */
};

/* REQUEST */
struct sAdamsRequest {
    int ID;
    int NPAR;
    const double *PAR;
    const char *COMMENT;
    const char *TITLE[8];
};

/* SENSOR */
struct sAdamsSensor {
    int ID;
    int NPAR;
    const double *PAR;
    double VALUE; /* in radians where it is an angle */
    double Error;
    char Logic[2]; /* EQ, GE, LE */
};

/* COUPLER: T or R for each joint */
struct sAdamsCoupler {
    int ID;
    int NPAR;
    const double *PAR;
    int NJOINT;
    int JOINTS[3];
    char TYPE[3];
};

/* CURVE */
struct sAdamsCurve {
    int ID;
    int NPAR;
    const double *PAR;
    int CLOSED;
    int ORDER;
    double MINPAR;
    double MAXPAR;
};

/* CONTACT: the numbers of its GRAPHICS, and whether each is turned inside out */
struct sAdamsContact {
    int ID;
    int nIGEOM;
    int nJGEOM;
    int *IGEOM;
    int *JGEOM;
    int *IFLIP_GEOM;
    int *JFLIP_GEOM;
};

/* A contact with the numbers of USER: this one alone does not begin with them. */
struct sAdamsContactFriction {
    struct sAdamsContact contact;
    int NPAR;
    const double *PAR;
};

/* GSE: numbers of its arrays, and how many inputs, outputs and states it has */
struct sAdamsGSE {
    int ID;
    int NPAR;
    const double *PAR;
    int NI;
    int NO;
    int U;
    int Y;
    int NS;
    int X;
    int IC;
    int STATIC_HOLD;
    int IMPLICIT;
    int STATICS_ONLY;
    int ND;
    int XD;
    int ICD;
    double SAMPLE_OFFSET;
};

/*
 * The forms of routines. IFLAG is 1 in the first call, before anything is computed: what a routine
 * then asks of c_sysfnc and c_sysary is what it may ask later. DFLAG is always 0: derivatives are
 * found by differences. Results are zero when a routine is called.
 */
typedef void adams_c_Sfosub(const struct sAdamsSforce *sforce, double TIME, int DFLAG, int IFLAG,
                            double *RESULT);
/* FX, FY, FZ in the axes of RM */
typedef void adams_c_Vfosub(const struct sAdamsVforce *vforce, double TIME, int DFLAG, int IFLAG,
                            double *RESULT);
/* TX, TY, TZ */
typedef void adams_c_Vtosub(const struct sAdamsVtorque *vtorque, double TIME, int DFLAG, int IFLAG,
                            double *RESULT);
/* FX, FY, FZ, TX, TY, TZ */
typedef void adams_c_Gfosub(const struct sAdamsGforce *gforce, double TIME, int DFLAG, int IFLAG,
                            double *RESULT);
typedef void adams_c_Varsub(const struct sAdamsVariable *variable, double TIME, int DFLAG,
                            int IFLAG, double *RESULT);
/* the rate, or what is zero where the DIFF is implicit */
typedef void adams_c_Difsub(const struct sAdamsDiff *diff, double TIME, int DFLAG, int IFLAG,
                            double *RESULT);
/* called for IORD 0, 1 and 2: the value, and its first and second derivative in time */
typedef void adams_c_Motsub(const struct sAdamsMotion *motion, double TIME, int IORD, int IFLAG,
                            double *RESULT);
/* eight components */
typedef void adams_c_Reqsub(const struct sAdamsRequest *request, double TIME, int IFLAG,
                            double *OUTPUT);
typedef void adams_c_Sensub(const struct sAdamsSensor *sensor, double TIME, int IFLAG,
                            double *OUTPUT);
/* rates of the states, and outputs */
typedef void adams_c_Gsesub(const struct sAdamsGSE *gse, double TIME, int DFLAG, int IFLAG,
                            int NSTATE, const double *STATES, int NINPUT, const double *INPUTS,
                            int NOUTPUT, double *STATED, double *OUTPUT);

/* what is zero, of the displacements of two or three joints; it asks for nothing */
typedef void adams_c_Cousub(const struct sAdamsCoupler *coupler, double TIME, const double *DISP,
                            int IFLAG, double *PHI);
/* its partial derivatives, one for each displacement */
typedef adams_c_Cousub adams_c_Couxx;
/* its second ones, row by row, one for each pair of displacements */
typedef adams_c_Cousub adams_c_Couxx2;
/* x, y, z for IORD 0, their first and second derivative for 1 and 2; it asks for nothing */
typedef void adams_c_Cursub(const struct sAdamsCurve *curve, double ALPHA, int IORD, int IFLAG,
                            double *VALUES);
/*
 * The force along the normal, in RESULT[0]: positive pushes. LOCI and NI are the point and the
 * outward normal of I's solid in the frame of its marker, LOCJ and NJ those of J's; GAP is
 * negative. GAPDOTDOT and AREA are 0.
 */
typedef void adams_c_Cnfsub(const struct sAdamsContactFriction *contact, double TIME,
                            const double *LOCI, const double *NI, const double *LOCJ,
                            const double *NJ, double GAP, double GAPDOT, double GAPDOTDOT,
                            double AREA, int DFLAG, int IFLAG, double *RESULT);
/*
 * The friction on I's solid along its slip, in RESULT[0]: negative brakes. XDOT[0] is the speed of
 * the slip; the rest of XDOT, X and AREA are 0.
 */
typedef void adams_c_Cffsub(const struct sAdamsContactFriction *contact, double TIME,
                            const double *LOCI, const double *LOCJ, const double *X,
                            const double *XDOT, double NFORCE, double AREA, int DFLAG, int IFLAG,
                            double *RESULT);

/*
 * What a routine may call. `errflg` becomes 1 where there is no such function.
 */

/* A function of the model (DX, VM, VARVAL ...): `ipar` are the numbers in its parentheses. */
void c_sysfnc(const char *fncnam, const int *ipar, int nsize, double *states, int *errflg);
/* Several at once: TDISP, RDISP, DISP, TVEL, RVEL, VEL, TACC, RACC, ACC, TFORCE, RFORCE, FORCE. */
void c_sysary(const char *fncnam, const int *ipar, int nsize, double *states, int *nstate,
              int *errflg);
/* Takes derivatives, and does nothing with them. */
void c_syspar(const char *fncnam, const int *ipar, int nsize, const double *states, int nstate,
              int *errflg);
/* Where errflg is not 0: tells the message, and with "STOP" ends the run. */
void c_errmes(int errflg, const char *mesage, int id, const char *endflg);
/* Where msgflg is not 0: tells the message once; with "FAULT" it ends the run. */
void c_usrmes(int msgflg, const char *mesage, int id, const char *msgtyp);
/* The time. */
void c_timget(double *time);

#ifdef __cplusplus
}
#endif

#endif
