!-------------------------- Default Units for Model ---------------------------!
defaults units  &
   length = meter  &
   angle = rad
model create  &
   model_name = saved
part create rigid_body name_and_position  &
   part_name = .saved.rod  &
   adams_id = 2  &
   location = 0.0, 0.0, 0.0
marker create  &
   marker_name = .saved.rod.a  &
   adams_id = 1  &
   location = 0.5, 0.0, 0.0
ude create instance  &
   instance_name = .saved.S  &
   definition_name = .MDI.Forces.spring
variable modify  &
   variable_name = .saved.S.i_marker  &
   object_value = .saved.rod.a
simulation script create  &
   sim_script_name = .saved.Last_Sim  &
   commands = "simulation single_run transient type=dynamic end_time=1.0 step_size=0.1"
!---------------------------- Expression definitions ----------------------------!
marker modify  &
   marker_name = .saved.rod.a  &
   location =   &
      (LOC_RELATIVE_TO({0.5, 0, 0}, .saved.rod))  &
   relative_to = .saved.rod
part attributes  &
   part_name = .saved.rod  &
   active = off
